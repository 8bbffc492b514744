// Frames as a worse camera, or worse weather, would have given them; scripts/robustness measures
// the detector on the result.
//
// usage: degrade_frames KIND TO_DIR IMAGE...
//
// KIND is blur, noise, darkness, over-exposure, fog or half-resolution. Writes PNG files of the
// same names, whatever their endings say, to TO_DIR. The same images give the same files.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/files.h"
#include "evaluate/image_detector.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

cv::Mat3b with_noise(const cv::Mat3b& picture, double deviation) {
  cv::RNG random(1);
  cv::Mat3s noise(picture.size());
  random.fill(noise, cv::RNG::NORMAL, cv::Scalar::all(0), cv::Scalar::all(deviation));
  cv::Mat3b result;
  cv::add(picture, noise, result, cv::noArray(), CV_8U);
  return result;
}

cv::Mat3b scaled(const cv::Mat3b& picture, double gain, double offset) {
  cv::Mat3b result;
  picture.convertTo(result, CV_8U, gain, offset);
  return result;
}

const std::map<std::string, std::function<cv::Mat3b(const cv::Mat3b&)>> kKinds = {
    {"blur",
     [](const cv::Mat3b& picture) {
       cv::Mat3b result;
       cv::GaussianBlur(picture, result, {}, 2.0);
       return result;
     }},
    {"noise", [](const cv::Mat3b& picture) { return with_noise(picture, 15); }},
    // A dark frame is noisy, too.
    {"darkness", [](const cv::Mat3b& picture) { return with_noise(scaled(picture, 0.2, 0), 3); }},
    {"over-exposure", [](const cv::Mat3b& picture) { return scaled(picture, 2, 0); }},
    // A veil of the same strength everywhere.
    {"fog", [](const cv::Mat3b& picture) { return with_noise(scaled(picture, 0.35, 130), 2); }},
    {"half-resolution",
     [](const cv::Mat3b& picture) {
       cv::Mat3b result;
       cv::resize(picture, result, {}, 0.5, 0.5, cv::INTER_AREA);
       return result;
     }},
};

}  // namespace
}  // namespace bole

int main(int count, char** arguments) {
  const auto kind = count > 3 ? bole::kKinds.find(arguments[1]) : bole::kKinds.end();
  if (kind == bole::kKinds.end()) {
    std::fputs(
        "usage: degrade_frames blur|noise|darkness|over-exposure|fog|half-resolution TO_DIR "
        "IMAGE...\n",
        stderr);
    return 2;
  }
  try {
    for (int i = 3; i < count; ++i) {
      const bole::fs::path image = arguments[i];
      std::vector<std::uint8_t> png;
      cv::imencode(".png", kind->second(bole::read_picture(image)), png,
                   {cv::IMWRITE_PNG_COMPRESSION, 1});
      bole::write_file_atomically(bole::fs::path(arguments[2]) / image.filename(),
                                  std::as_bytes(std::span(png)));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "degrade_frames: %s\n", error.what());
    return 1;
  }
  return 0;
}
