// Trees from LCM. lcm-gen -x /usr/share/bole/types/*.lcm && g++ subscribe_lcm.cpp -I. -llcm
// (/usr/local/share/bole/types where bole was installed without its package)
#include <cstdio>

#include <lcm/lcm-cpp.hpp>

#include "bole/tree_list_t.hpp"

struct Handler {
  // A message of a foreign or newer type does not get here: LCM's decoder names it on stderr.
  void on_trees(const lcm::ReceiveBuffer*, const std::string&, const bole::tree_list_t* list) {
    if (list->flags & bole::tree_list_t::FLAG_DEGRADED) std::puts("the camera cannot see well");
    for (const bole::tree_t& tree : list->trees) {
      std::printf("#%d: %+.3f rad, %.2f +- %.2f m\n", tree.id, tree.bearing, tree.range,
                  tree.range_sigma);
    }
  }
};

int main() {
  lcm::LCM bus("udpm://239.255.76.67:7667?ttl=0");
  Handler handler;
  bus.subscribe("BOLE_TREES", &Handler::on_trees, &handler);
  while (bus.handle() == 0) {
  }
}
