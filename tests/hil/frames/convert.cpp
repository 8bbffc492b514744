// hil_frames IN OUT: writes each picture of folder IN in every pixel format that the rig's cameras
// have, as a camera with that format would deliver it: OUT/<format>/<name>.<format>, tightly
// packed. Formats are named as in the project (base/image.h), so each OUT/<format> is a folder for
// replay.
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<unsigned char>;

Bytes bytes_of(const cv::Mat& image) {
  return {image.datastart, image.dataend};  // fresh images are contiguous
}

cv::Mat converted(const cv::Mat& bgr, int code) {
  cv::Mat out;
  cv::cvtColor(bgr, out, code);
  return out;
}

// Two pixels share the chroma of the first: Y0 U Y1 V, or with chroma first.
Bytes yuv_422(const cv::Mat& bgr, bool chroma_first) {
  const cv::Mat ycrcb = converted(bgr, cv::COLOR_BGR2YCrCb);
  Bytes out;
  out.reserve(ycrcb.total() * 2);
  for (int row = 0; row < ycrcb.rows; ++row) {
    for (int column = 0; column < ycrcb.cols; ++column) {
      const unsigned char luma = ycrcb.at<cv::Vec3b>(row, column)[0];
      const auto& pair = ycrcb.at<cv::Vec3b>(row, column & ~1);
      const unsigned char chroma = column % 2 == 0 ? pair[2] : pair[1];
      out.push_back(chroma_first ? chroma : luma);
      out.push_back(chroma_first ? luma : chroma);
    }
  }
  return out;
}

// A plane of luma, then one of interleaved U and V for blocks of two by two.
Bytes nv12(const cv::Mat& bgr) {
  const cv::Mat ycrcb = converted(bgr, cv::COLOR_BGR2YCrCb);
  cv::Mat luma;
  cv::extractChannel(ycrcb, luma, 0);
  Bytes out = bytes_of(luma);
  for (int row = 0; row < ycrcb.rows; row += 2) {
    for (int column = 0; column < ycrcb.cols; column += 2) {
      const auto& pixel = ycrcb.at<cv::Vec3b>(row, column);
      out.insert(out.end(), {pixel[2], pixel[1]});
    }
  }
  return out;
}

// `pattern` names the colours of the first two pixels of the first two rows.
Bytes bayer(const cv::Mat& bgr, const std::string& pattern) {
  Bytes out;
  out.reserve(bgr.total());
  for (int row = 0; row < bgr.rows; ++row) {
    for (int column = 0; column < bgr.cols; ++column) {
      const char colour = pattern.at(2 * (row % 2) + column % 2);
      const int channel = colour == 'b' ? 0 : colour == 'g' ? 1 : 2;
      out.push_back(bgr.at<cv::Vec3b>(row, column)[channel]);
    }
  }
  return out;
}

Bytes jpeg(const cv::Mat& bgr) {
  Bytes out;
  cv::imencode(".jpg", bgr, out, {cv::IMWRITE_JPEG_QUALITY, 90});
  return out;
}

const std::map<std::string, std::function<Bytes(const cv::Mat&)>> kFormats = {
    {"yuyv", [](const cv::Mat& bgr) { return yuv_422(bgr, false); }},
    {"uyvy", [](const cv::Mat& bgr) { return yuv_422(bgr, true); }},
    {"nv12", nv12},
    {"grey", [](const cv::Mat& bgr) { return bytes_of(converted(bgr, cv::COLOR_BGR2GRAY)); }},
    {"rggb", [](const cv::Mat& bgr) { return bayer(bgr, "rggb"); }},
    {"grbg", [](const cv::Mat& bgr) { return bayer(bgr, "grbg"); }},
    {"gbrg", [](const cv::Mat& bgr) { return bayer(bgr, "gbrg"); }},
    {"bggr", [](const cv::Mat& bgr) { return bayer(bgr, "bggr"); }},
    {"rgb24", [](const cv::Mat& bgr) { return bytes_of(converted(bgr, cv::COLOR_BGR2RGB)); }},
    {"bgr24", bytes_of},
    {"mjpeg", jpeg},
};

void convert(const fs::path& picture, const fs::path& out) {
  const cv::Mat bgr = cv::imread(picture.string(), cv::IMREAD_COLOR);
  if (bgr.empty()) throw std::runtime_error(picture.string() + ": not a picture");
  for (const auto& [format, encode] : kFormats) {
    fs::create_directories(out / format);
    const Bytes bytes = encode(bgr);
    std::ofstream file(out / format / picture.filename().replace_extension(format),
                       std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    if (!file.flush()) throw std::runtime_error(out.string() + ": cannot be written");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: hil_frames IN OUT\n";
    return 2;
  }
  try {
    for (const auto& entry : fs::directory_iterator(argv[1])) {
      if (entry.path().filename().string().starts_with("frame_")) convert(entry.path(), argv[2]);
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "hil_frames: " << error.what() << "\n";
    return 1;
  }
}
