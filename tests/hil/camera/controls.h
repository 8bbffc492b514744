// The picture controls of the camera (UVC 1.1 section 4.2.2): exposure, gain and the like.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "byte_writer.h"

namespace hil {

struct Control {
  std::string_view name;  // of the commands and events of the rig
  unsigned entity;
  unsigned selector;
  int size_bytes;
  int32_t minimum;
  int32_t maximum;
  int32_t resolution;
  int32_t default_value;
  int32_t current = default_value;
  bool refused = false;  // answers every attempt to set it with a STALL
};

class Controls {
 public:
  Controls();

  Control* find(unsigned entity, unsigned selector);
  Control* find(std::string_view name);

 private:
  std::vector<Control> controls_;
};

/// The answer to GET_CUR, GET_MIN, ... (UVC 1.1 table 4-2), nothing for a request it has not.
std::optional<Bytes> read_control(const Control& control, unsigned request);

}  // namespace hil
