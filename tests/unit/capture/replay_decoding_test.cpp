#include "replayed.h"

#include <fstream>
#include <iterator>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "base/checksum.h"

namespace bole {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

cv::Mat picture(int width, int height, int type = CV_8UC3) {
  cv::Mat image(height, width, type);
  for (int row = 0; row < height; ++row) {
    for (int byte = 0; byte < width * image.channels(); ++byte) {
      image.ptr(row)[byte] = static_cast<unsigned char>(3 * row + 5 * byte);
    }
  }
  return image;
}

std::vector<unsigned char> file_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string pixels(const cv::Mat& image) {
  return {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()};
}

TEST(ReplayImages, DecodeAsOpenCvDoes) {
  const TemporaryFolder folder;
  for (const char* name : {"0.png", "1.jpg", "2.bmp", "3.ppm", "4.tiff", "5.webp"}) {
    cv::imwrite((folder / name).string(), picture(40, 30));
  }
  ReplayOptions options = options_for(folder.path());
  options.size = {40, 30};
  const Replayed seen = replay(options);
  ASSERT_EQ(seen.frames.size(), 6U) << testing::PrintToString(seen.bad);
  for (const Seen& frame : seen.frames) {
    const cv::Mat expected = cv::imdecode(file_bytes(folder / frame.file), cv::IMREAD_COLOR);
    EXPECT_TRUE(frame.bytes == pixels(expected)) << frame.file;
  }
}

TEST(ReplayImages, KeepGreyGreyAndTakeSixteenBits) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "0.png").string(), picture(4, 2, CV_8UC1));
  cv::imwrite((folder / "1.jpg").string(), picture(4, 2, CV_8UC1));
  cv::imwrite((folder / "2.png").string(), cv::Mat(2, 4, CV_16UC1, cv::Scalar(0x4321)));
  const Replayed seen = replay(options_for(folder.path()));
  ASSERT_EQ(seen.frames.size(), 3U);
  EXPECT_EQ(seen.frames[0].bytes, pixels(picture(4, 2, CV_8UC1)));
  EXPECT_EQ(seen.frames[1].bytes.size(), 8U);
  EXPECT_EQ(seen.frames[2].bytes, grey_pixels(0x43));
}

TEST(ReplayImages, DecodePngOfAnyDepthAsOpenCvDoes) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "alpha.png").string(), picture(40, 30, CV_8UC4));
  cv::imwrite((folder / "bits.png").string(), picture(40, 30, CV_8UC1),
              {cv::IMWRITE_PNG_BILEVEL, 1});
  cv::imwrite((folder / "deep.png").string(), picture(40, 30, CV_16UC3));
  ReplayOptions options = options_for(folder.path());
  options.size = {40, 30};
  const Replayed seen = replay(options);
  ASSERT_EQ(seen.frames.size(), 3U) << testing::PrintToString(seen.bad);
  for (const Seen& frame : seen.frames) {
    const cv::Mat expected = cv::imdecode(file_bytes(folder / frame.file), cv::IMREAD_ANYCOLOR);
    EXPECT_TRUE(frame.bytes == pixels(expected)) << frame.file;
  }
}

TEST(ReplayImages, OfAnotherSizeOrDamagedAreBad) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "0.png").string(), picture(4, 2));
  cv::imwrite((folder / "1.png").string(), picture(2, 4));
  cv::imwrite((folder / "2.jpg").string(), picture(2, 4));
  for (const char* name : {"3.jpg", "4.png"}) {
    const std::string path = (folder / name).string();
    cv::imwrite(path, picture(4, 2));
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  }
  const Replayed seen = replay(options_for(folder.path()));
  EXPECT_THAT(files_of(seen), ElementsAre("0.png"));
  EXPECT_THAT(seen.bad, ElementsAre(HasSubstr("1.png: has 2 x 4 pixels"),
                                    HasSubstr("2.jpg: has 2 x 4 pixels"),
                                    HasSubstr("3.jpg: is a damaged JPEG"),
                                    HasSubstr("4.png: is a damaged PNG image: cut short")));
}

TEST(ReplayImages, AsJpegMayHaveAFewBytesTooManyAtTheirEnd) {
  const TemporaryFolder folder;
  const std::string plain = (folder / "0.jpg").string();
  cv::imwrite(plain, picture(40, 30));
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture(40, 30), bytes);
  for (const std::size_t padding : {1, 2, 4, 16, 1000}) {
    std::string file(bytes.begin(), bytes.end());
    file.insert(file.size() - 2, padding, '\0');
    folder.write(std::to_string(padding) + ".jpg", file);
  }
  ReplayOptions options = options_for(folder.path());
  options.size = {40, 30};
  const Replayed seen = replay(options);
  EXPECT_THAT(files_of(seen), ElementsAre("0.jpg", "1.jpg", "16.jpg", "2.jpg", "4.jpg"));
  EXPECT_THAT(seen.bad, ElementsAre(HasSubstr("1000.jpg: is a damaged JPEG")));
  for (const Seen& frame : seen.frames) EXPECT_TRUE(frame.bytes == seen.frames[0].bytes);
}

TEST(ReplayImages, AsPngDamagedInsideAreToldByUsAlone) {
  const TemporaryFolder folder;
  for (const char* name : {"0.png", "1.png"}) {
    cv::imwrite((folder / name).string(), picture(4, 2));
  }
  std::fstream file(folder / "1.png", std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(-20, std::ios::end);  // in the last of the pixels
  file << "leaf" << std::flush;
  testing::internal::CaptureStderr();
  const Replayed seen = replay(options_for(folder.path()));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(files_of(seen), ElementsAre("0.png"));
  EXPECT_THAT(seen.bad, ElementsAre(HasSubstr("1.png: is a damaged PNG image")));
}

TEST(ReplayImages, ThatClaimToBeHugeAreRefusedUndecoded) {
  const TemporaryFolder folder;
  const auto chunk = [](const std::string& body) {  // a type and what it holds
    std::string all;
    const auto append = [&all](std::size_t number) {
      for (const int shift : {24, 16, 8, 0}) all += static_cast<char>(number >> shift);
    };
    append(body.size() - 4);
    all += body;
    append(crc32(std::as_bytes(std::span(body))));
    return all;
  };
  const std::string file = "\x89PNG\r\n\x1a\n" +
                           chunk({"IHDR\0\0\xff\xff\0\0\xff\xff\x08\0\0\0\0", 17}) + chunk("IDAT") +
                           chunk("IEND");
  folder.write("0.png", file);
  EXPECT_THAT(refusal(options_for(folder / "0.png")), HasSubstr("has 65535 x 65535 pixels"));
  folder.write("1.pgm", "P5 65535 65535 255\n");
  EXPECT_THAT(refusal(options_for(folder / "1.pgm")), HasSubstr("MAX_IMAGE_PIXELS"));
}

TEST(ReplayVideo, PlaysEveryFrameAtItsOwnRate) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "drive.avi";
  {
    cv::VideoWriter writer(path.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20,
                           {64, 48});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < 5; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 * i)));
  }
  ReplayOptions options = options_for(path);
  options.size = {64, 48};
  Replayed seen = replay(options);
  EXPECT_THAT(utimes_of(seen), ElementsAre(0, 50'000, 100'000, 150'000, 200'000));
  for (std::size_t i = 0; i < seen.frames.size(); ++i) {
    EXPECT_EQ(seen.frames[i].file, "drive.avi");
    EXPECT_NEAR(static_cast<unsigned char>(seen.frames[i].bytes[4000]),
                40.0 * static_cast<double>(i), 3);
  }
  options.loop = true;
  seen = replay(options, 7);
  EXPECT_EQ(seen.frames[6].utime_us, 300'000);
  EXPECT_NEAR(static_cast<unsigned char>(seen.frames[6].bytes[4000]), 40, 3);
  options.size = kSize;
  EXPECT_THAT(refusal(options), HasSubstr("has 64 x 48 pixels"));
}

}  // namespace
}  // namespace bole
