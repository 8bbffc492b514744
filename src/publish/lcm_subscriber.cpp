#include "publish/lcm_subscriber.h"

#include <string_view>

namespace bole {

LcmSubscriber::LcmSubscriber(const LcmUrl& url, Receive receive) : receive_(std::move(receive)) {
  const std::string problem = missing_route(url);
  if (!problem.empty()) throw BusError(problem);
  lcm_.reset(lcm_create(url.text().c_str()));
  if (!lcm_) throw BusError("cannot open " + url.text());
  for (const char* channel : {kTreesChannel, kStatusChannel}) {
    if (lcm_subscribe(lcm_.get(), channel, on_message, this) == nullptr) {
      throw BusError("cannot listen on " + url.text());
    }
  }
}

void LcmSubscriber::on_message(const lcm_recv_buf_t* message, const char* channel, void* self) {
  const auto kind =
      std::string_view(channel) == kTreesChannel ? MessageKind::trees : MessageKind::status;
  static_cast<LcmSubscriber*>(self)->receive_(
      kind, {static_cast<const std::byte*>(message->data), message->data_size});
}

}  // namespace bole
