// The camera as a test handles it: plug in, pull out, make it misbehave.
#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "usbip.h"
#include "video_function.h"
#include "video_stream.h"

namespace hil {

class Camera {
 public:
  Camera(VideoFunction& function, unsigned port) : function_(function), port_(port) {}

  void plug();    // nothing if plugged; throws std::system_error if the kernel does not take it
  void unplug();  // nothing if not; returns when all of the connection is gone

  /// Takes effect at once, or when plugged in.
  void change_faults(const std::function<void(StreamFaults&)>& change);

 private:
  // One plugging-in. Threads last, so that they end before what they use.
  struct Connection {
    Connection(VideoFunction& function, unsigned port, const StreamFaults& faults);
    ~Connection();
    void receive(VideoFunction& function);

    VhciAttachment attachment;
    VideoStream stream;
    std::thread receiver;
    std::thread sender;
  };

  VideoFunction& function_;
  const unsigned port_;
  StreamFaults faults_;
  std::unique_ptr<Connection> connection_;
};

}  // namespace hil
