#include "publish/encoder.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>

namespace bole {
namespace {

constexpr std::size_t kMostTrees = tree_list_t::MAX_TREES;

bool finite(const Tree& tree) {
  return std::ranges::all_of(
      std::array{tree.bearing, tree.range, tree.diameter, tree.score, tree.bearing_sigma,
                 tree.range_sigma, tree.diameter_sigma, tree.base_elevation, tree.angular_width},
      [](float value) { return std::isfinite(value); });
}

// Of trees as far away the one with the smaller bearing comes first, so that the bytes do not
// depend on the order in which the detector found them.
bool nearer(const Tree& a, const Tree& b) {
  return std::tie(a.range, a.bearing, a.id) < std::tie(b.range, b.bearing, b.id);
}

tree_t wire_form(const Tree& tree) {
  tree_t wire;
  wire.id = tree.id;
  wire.bearing = tree.bearing;
  wire.range = tree.range;
  wire.diameter = tree.diameter;
  wire.score = tree.score;
  wire.bearing_sigma = tree.bearing_sigma;
  wire.range_sigma = tree.range_sigma;
  wire.diameter_sigma = tree.diameter_sigma;
  wire.base_elevation = tree.base_elevation;
  wire.angular_width = tree.angular_width;
  return wire;
}

// Cut between characters, not within one: the bytes that go on a UTF-8 character are 10xxxxxx.
void cut(std::string& text, std::size_t most) {
  if (text.size() <= most) return;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0) == 0x80) --most;
  text.resize(most);
}

// A number that is cut must not read as a whole one.
void shorten(std::string& text) {
  if (text.size() <= kMostStatusTextBytes) return;
  constexpr std::string_view kMore = "...";
  cut(text, kMostStatusTextBytes - kMore.size());
  text += kMore;
}

void make_finite(float& value) {
  if (!std::isfinite(value)) value = 0;
}

}  // namespace

TreeListEncoder::TreeListEncoder() : bytes_{} {
  message_.trees.reserve(kMostTrees);
  message_.camera.reserve(64);
  chosen_.reserve(256);
}

void TreeListEncoder::choose_trees(std::span<const Tree> trees) {
  chosen_.clear();
  std::ranges::copy_if(trees, std::back_inserter(chosen_), finite);
  rejected_ += static_cast<std::int64_t>(trees.size() - chosen_.size());
  std::ranges::sort(chosen_, nearer);
}

std::span<const std::byte> TreeListEncoder::encode(const TreeList& list) {
  choose_trees(list.trees);
  const bool truncated = chosen_.size() > kMostTrees;
  if (truncated) chosen_.resize(kMostTrees);

  message_.utime = list.utime;
  message_.capture_mono_ns = list.capture_mono_ns;
  message_.publish_mono_ns = list.publish_mono_ns;
  message_.seq = list.seq;
  message_.sensor_seq = list.sensor_seq;
  message_.config_crc = static_cast<std::int32_t>(list.config_crc);
  message_.source = static_cast<std::int8_t>(list.source);
  message_.flags =
      static_cast<std::int8_t>((truncated ? tree_list_t::FLAG_TRUNCATED : 0) |
                               (list.degraded ? tree_list_t::FLAG_DEGRADED : 0) |
                               (list.source == ListSource::replay ? tree_list_t::FLAG_REPLAY : 0));
  message_.camera = list.camera;
  cut(message_.camera, kMostCameraBytes);
  message_.num_trees = static_cast<std::int32_t>(chosen_.size());
  message_.trees.clear();
  std::ranges::transform(chosen_, std::back_inserter(message_.trees), wire_form);

  const int size = message_.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
  return {bytes_.data(), static_cast<std::size_t>(size)};
}

void encode_status(status_t status, std::vector<std::byte>& bytes) {
  for (std::string* text : {&status.version, &status.camera, &status.source, &status.state_reason,
                            &status.degraded_reason, &status.last_error}) {
    shorten(*text);
  }
  for (float* value : {&status.frame_rate, &status.list_rate, &status.latency_p50_ms,
                       &status.latency_p99_ms, &status.latency_max_ms}) {
    make_finite(*value);
  }
  for (std::vector<counter_t>* counters : {&status.drops, &status.camera_events}) {
    for (counter_t& counter : *counters) shorten(counter.name);
  }
  for (bus_t& bus : status.buses) {
    shorten(bus.name);
    shorten(bus.last_error);
    make_finite(bus.handover_p50_us);
    make_finite(bus.handover_p99_us);
    make_finite(bus.handover_max_us);
  }
  status.num_drops = static_cast<std::int32_t>(status.drops.size());
  status.num_camera_events = static_cast<std::int32_t>(status.camera_events.size());
  status.num_buses = static_cast<std::int32_t>(status.buses.size());
  bytes.resize(static_cast<std::size_t>(status.getEncodedSize()));
  status.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
}

}  // namespace bole
