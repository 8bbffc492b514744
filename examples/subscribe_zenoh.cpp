// Trees from Zenoh, with bole's own library (built in its source tree, which holds what it
// includes): subscribe_zenoh [tcp/127.0.0.1:7447]
#include <cstdio>

#include "publish/decoder.h"
#include "publish/zenoh_session.h"

int main(int argc, char** argv) {
  bole::ZenohConfig config;
  config.mode = "client";
  config.connect = {argc > 1 ? argv[1] : "tcp/127.0.0.1:7447"};
  bole::ZenohSession session(config, std::nullopt, {"bole/*/*/trees"});
  for (;;) {
    for (const auto& message : session.receive(std::chrono::seconds(1))) {
      if (message.event != bole::ZenohMessage::Event::sample) continue;
      try {
        const bole::tree_list_t list = bole::decode_tree_list(message.payload);
        if (list.flags & bole::tree_list_t::FLAG_DEGRADED) std::puts("the camera cannot see well");
        for (const bole::tree_t& tree : list.trees) {
          std::printf("#%d: %+.3f rad, %.2f +- %.2f m\n", tree.id, tree.bearing, tree.range,
                      tree.range_sigma);
        }
      } catch (const bole::WireError& error) {
        std::printf("%s %s\n", message.key.c_str(), error.what());
      }
    }
  }
}
