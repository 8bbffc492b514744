#include "publish/json_line.h"

#include <array>
#include <charconv>
#include <concepts>
#include <string_view>

#include <nlohmann/json.hpp>

namespace bole {
namespace {

// Writes one object after the other, fields in the order of the calls.
class JsonWriter {
 public:
  explicit JsonWriter(std::string& out) : out_(out) {}

  template <typename Number>
  requires std::integral<Number> || std::floating_point<Number>
  void field(std::string_view key, Number value) {
    name(key);
    number(value);
  }
  void field(std::string_view key, const std::string& value) {
    name(key);
    out_ += nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  void truth(std::string_view key, bool value) {
    name(key);
    out_ += value ? "true" : "false";
  }

  template <typename Elements, typename WriteElement>
  void array(std::string_view key, const Elements& elements, WriteElement write_element) {
    name(key);
    out_ += '[';
    for (const auto& element : elements) {
      comma();
      write_element(element);
    }
    out_ += ']';
  }
  template <typename WriteFields>
  void object(WriteFields write_fields) {
    out_ += '{';
    write_fields();
    out_ += '}';
  }
  template <typename Number>
  void number(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    out_.append(digits.data(), end);
  }

 private:
  void comma() {
    if (out_.back() != '{' && out_.back() != '[') out_ += ',';
  }
  void name(std::string_view key) {
    comma();
    out_ += '"';
    out_ += key;
    out_ += "\":";
  }

  std::string& out_;
};

void write_tree(JsonWriter& json, const tree_t& tree) {
  json.object([&] {
    json.field("id", tree.id);
    json.field("bearing", tree.bearing);
    json.field("range", tree.range);
    json.field("diameter", tree.diameter);
    json.field("score", tree.score);
    json.field("bearing_sigma", tree.bearing_sigma);
    json.field("range_sigma", tree.range_sigma);
    json.field("diameter_sigma", tree.diameter_sigma);
    json.field("base_elevation", tree.base_elevation);
    json.field("angular_width", tree.angular_width);
  });
}

void write_counter(JsonWriter& json, const counter_t& counter) {
  json.object([&] {
    json.field("name", counter.name);
    json.field("count", counter.count);
  });
}

void write_bus(JsonWriter& json, const bus_t& bus) {
  json.object([&] {
    json.field("name", bus.name);
    json.truth("healthy", bus.healthy != 0);
    json.field("published", bus.published);
    json.field("overwritten", bus.overwritten);
    json.field("failed", bus.failed);
    json.field("handover_p50_us", bus.handover_p50_us);
    json.field("handover_p99_us", bus.handover_p99_us);
    json.field("handover_max_us", bus.handover_max_us);
    json.array("handover_histogram", bus.handover_histogram,
               [&](std::int32_t count) { json.number(count); });
    json.field("last_error", bus.last_error);
  });
}

}  // namespace

void write_json_line(const tree_list_t& list, const std::string& file, std::string& line) {
  line.clear();
  JsonWriter json(line);
  json.object([&] {
    if (!file.empty()) json.field("file", file);
    json.field("utime", list.utime);
    json.field("capture_mono_ns", list.capture_mono_ns);
    json.field("publish_mono_ns", list.publish_mono_ns);
    json.field("seq", list.seq);
    json.field("sensor_seq", list.sensor_seq);
    json.field("config_crc", list.config_crc);
    json.field("source", list.source);
    json.field("flags", list.flags);
    json.field("camera", list.camera);
    json.field("num_trees", list.num_trees);
    json.array("trees", list.trees, [&](const tree_t& tree) { write_tree(json, tree); });
  });
  line += '\n';
}

void write_json_line(const status_t& status, std::string& line) {
  line.clear();
  JsonWriter json(line);
  json.object([&] {
    json.field("utime", status.utime);
    json.field("mono_ns", status.mono_ns);
    json.field("uptime_ns", status.uptime_ns);
    json.field("version", status.version);
    json.field("camera", status.camera);
    json.field("source", status.source);
    json.field("state", status.state);
    json.field("state_reason", status.state_reason);
    json.truth("degraded", status.degraded != 0);
    json.field("degraded_reason", status.degraded_reason);
    json.field("frames", status.frames);
    json.field("lists", status.lists);
    json.field("frame_rate", status.frame_rate);
    json.field("list_rate", status.list_rate);
    json.field("latency_p50_ms", status.latency_p50_ms);
    json.field("latency_p99_ms", status.latency_p99_ms);
    json.field("latency_max_ms", status.latency_max_ms);
    json.field("num_drops", status.num_drops);
    json.array("drops", status.drops, [&](const counter_t& drop) { write_counter(json, drop); });
    json.field("num_camera_events", status.num_camera_events);
    json.array("camera_events", status.camera_events,
               [&](const counter_t& event) { write_counter(json, event); });
    json.field("num_buses", status.num_buses);
    json.array("buses", status.buses, [&](const bus_t& bus) { write_bus(json, bus); });
    json.field("last_error", status.last_error);
  });
  line += '\n';
}

}  // namespace bole
