// Trees from Zenoh, with bole's own library: subscribe_zenoh tcp/127.0.0.1:7447
#include <cstdio>

#include "publish/decoder.h"
#include "publish/zenoh_session.h"

int main(int /*argc*/, char** argv) {
  bole::ZenohConfig config;
  config.mode = "client";
  config.connect = {argv[1]};
  bole::ZenohSession session(config, std::nullopt, {"bole/*/*/trees"});
  for (;;) {
    for (const auto& message : session.receive(std::chrono::seconds(1))) {
      if (message.event != bole::ZenohMessage::Event::sample) continue;
      try {
        for (const bole::tree_t& tree : bole::decode_tree_list(message.payload).trees) {
          std::printf("#%d: %+.3f rad, %.2f +- %.2f m\n", tree.id, tree.bearing, tree.range,
                      tree.range_sigma);
        }
      } catch (const bole::WireError& error) {
        std::printf("%s %s\n", message.key.c_str(), error.what());
      }
    }
  }
}
