#include "camera.h"

#include <cerrno>

#include "events.h"

namespace hil {

void Camera::plug() {
  if (connection_) return;
  connection_ = std::make_unique<Connection>(function_, port_, faults_);
  Event("plugged");
}

void Camera::unplug() {
  if (!connection_) return;
  faults_ = connection_->stream.faults();
  connection_.reset();
  Event("unplugged");
}

void Camera::change_faults(const std::function<void(StreamFaults&)>& change) {
  if (connection_) {
    connection_->stream.change_faults(change);
  } else {
    change(faults_);
  }
}

Camera::Connection::Connection(VideoFunction& function, unsigned port, const StreamFaults& faults)
    : attachment(port),
      stream(attachment.link(), faults),
      receiver([this, &function] { receive(function); }),
      sender([this] { stream.run(); }) {}

Camera::Connection::~Connection() {
  attachment.detach();
  receiver.join();
  sender.join();
}

void Camera::Connection::receive(VideoFunction& function) {
  while (auto command = attachment.link().receive()) {
    if (const auto* unlink = std::get_if<Unlink>(&*command)) {
      stream.unlink(*unlink);
      continue;
    }
    Submit& submit = std::get<Submit>(*command);
    if (submit.endpoint == kVideoEndpoint && submit.device_to_host) {
      stream.submit(std::move(submit));
    } else if (submit.endpoint == 0) {
      if (function.ignores(submit.setup)) continue;
      auto answer = function.control_transfer(submit.setup, submit.data, stream);
      if (answer && answer->size() > submit.length) answer->resize(submit.length);
      stream.answer_control(submit, answer ? 0 : -EPIPE, answer.value_or(Bytes{}));
    } else {
      stream.answer_control(submit, -EPIPE, {});
    }
  }
  stream.close();
}

}  // namespace hil
