// hil_camera: a USB Video Class camera in user space, plugged into the kernel it runs on. usbcore
// and uvcvideo make a /dev/videoN of it; the frames come from files, byte for byte.
//
//   hil_camera [--rates N,N...] [--serial S] [--product P] [--port N] FOURCC:WxH:FILE...
//
// The camera starts unplugged. It reads commands from standard input, one a line, and writes what
// happens as JSON lines to standard output; at the end of its input it unplugs itself and ends.
//
//   plug | unplug
//   freeze | run             no frames any more | frames at the negotiated rate (the default)
//   step N                   N more frames, then freeze
//   shorten N | mark N       cut the next N frames in half | set their error bit
//   refuse NAME | accept NAME    answer attempts to set the control with a STALL | or no longer
//   hesitate MS              answer requests of controls only after so many milliseconds
//   mute | answer            answer no request of a control | or do (the default)
#include <charconv>
#include <chrono>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera.h"
#include "events.h"

namespace {

struct Options {
  std::vector<unsigned> rates = {30, 15, 10, 5};
  hil::Identity identity;
  unsigned port = 0;
  std::vector<std::string> modes;
};

unsigned parse_number(const std::string& text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw std::runtime_error("not a number: " + text);
  }
  return value;
}

std::vector<unsigned> parse_rates(const std::string& text) {
  std::vector<unsigned> rates;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) rates.push_back(parse_number(item));
  if (rates.empty() || std::ranges::count(rates, 0u)) {
    throw std::runtime_error("--rates takes frames per second");
  }
  return rates;
}

Options parse_options(std::vector<std::string> arguments) {
  Options options;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (!argument.starts_with("--")) {
      options.modes.push_back(argument);
      continue;
    }
    if (i + 1 == arguments.size()) throw std::runtime_error(argument + " needs a value");
    const std::string& value = arguments[++i];
    if (argument == "--rates") {
      options.rates = parse_rates(value);
    } else if (argument == "--serial") {
      options.identity.serial = value;
    } else if (argument == "--product") {
      options.identity.product = value;
    } else if (argument == "--port") {
      options.port = parse_number(value);
    } else {
      throw std::runtime_error("no such option: " + argument);
    }
  }
  return options;
}

void obey(const std::string& line, hil::Camera& camera, hil::VideoFunction& function) {
  using Faults = hil::StreamFaults;
  std::istringstream words(line);
  std::string command, operand;
  words >> command >> operand;
  if (command == "plug") {
    camera.plug();
  } else if (command == "unplug") {
    camera.unplug();
  } else if (command == "freeze") {
    camera.change_faults([](Faults& faults) { faults.frames_allowed = 0; });
  } else if (command == "run") {
    camera.change_faults([](Faults& faults) { faults.frames_allowed = Faults::kUnlimited; });
  } else if (command == "step") {
    camera.change_faults([&](Faults& faults) { faults.frames_allowed = parse_number(operand); });
  } else if (command == "shorten") {
    camera.change_faults([&](Faults& faults) { faults.frames_to_shorten = parse_number(operand); });
  } else if (command == "mark") {
    camera.change_faults([&](Faults& faults) { faults.frames_to_mark = parse_number(operand); });
  } else if (command == "hesitate") {
    function.hesitate(std::chrono::milliseconds(parse_number(operand)));
  } else if (command == "mute" || command == "answer") {
    function.mute(command == "mute");
  } else if (command == "refuse" || command == "accept") {
    if (!function.refuse_control(operand, command == "refuse")) {
      throw std::runtime_error("no such control: " + operand);
    }
  } else {
    throw std::runtime_error("no such command: " + line);
  }
  hil::Event("done").add("command", line);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = parse_options({argv + 1, argv + argc});
    hil::VideoFunction function(options.identity, hil::load_video_modes(options.modes),
                                options.rates);
    hil::Camera camera(function, options.port);
    for (std::string line; std::getline(std::cin, line);) obey(line, camera, function);
    camera.unplug();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "hil_camera: " << error.what() << "\n";
    return 1;
  }
}
