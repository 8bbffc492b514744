#include "capture/replay/replay_source.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "base/checksum.h"
#include "base/errors.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr ImageSize kSize{4, 2};

std::string grey_pixels(char value) { return std::string(8, value); }

ReplayOptions options_for(const std::filesystem::path& path,
                          ReplayPace::Kind pace = ReplayPace::Kind::lockstep) {
  ReplayOptions options;
  options.path = path;
  options.size = kSize;
  options.pace.kind = pace;
  return options;
}

struct Seen {
  std::string file;
  std::int64_t seq;
  std::int64_t utime_us;
  std::string bytes;
};

std::string bytes_of(const Frame& frame) {
  const std::span<const std::byte> bytes = frame.image().planes[0].bytes;
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct Replayed {
  std::vector<Seen> frames;
  std::vector<std::string> bad;
  std::int64_t superseded = 0;
};

// Grabs until the end, or `most` frames.
Replayed replay(const ReplayOptions& options, std::size_t most = 1000) {
  ReplayClock clock;
  const auto source = make_replay_source(options, clock);
  source->open();
  Replayed seen;
  while (seen.frames.size() < most) {
    const Grab grab = source->grab(seconds(1));
    seen.superseded += grab.drops[DropCause::superseded];
    if (grab.kind == Grab::Kind::end) break;
    if (grab.kind == Grab::Kind::bad_frame) seen.bad.push_back(grab.reason);
    if (grab.kind != Grab::Kind::frame) continue;
    seen.frames.push_back({std::string(grab.frame.file()), grab.frame.sensor_seq(),
                           grab.frame.stamp().ns / 1000, bytes_of(grab.frame)});
  }
  return seen;
}

std::vector<std::string> files_of(const Replayed& seen) {
  std::vector<std::string> files;
  for (const Seen& frame : seen.frames) files.push_back(frame.file);
  return files;
}

std::vector<std::int64_t> utimes_of(const Replayed& seen) {
  std::vector<std::int64_t> utimes;
  for (const Seen& frame : seen.frames) utimes.push_back(frame.utime_us);
  return utimes;
}

std::string refusal(const ReplayOptions& options) {
  ReplayClock clock;
  try {
    make_replay_source(options, clock);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TemporaryFolder folder_of(int frames) {
  TemporaryFolder folder;
  for (int i = 0; i < frames; ++i) {
    folder.write("f" + std::to_string(i) + ".grey", grey_pixels(static_cast<char>('a' + i)));
  }
  return folder;
}

TEST(Replay, TakesFramesInTheByteOrderOfTheirNames) {
  const TemporaryFolder folder;
  for (const char* name : {"b.grey", "a10.grey", "a9.grey", "Z.grey", "\xc3\xa4.grey"}) {
    folder.write(name, grey_pixels('x'));
  }
  EXPECT_THAT(files_of(replay(options_for(folder.path()))),
              ElementsAre("Z.grey", "a10.grey", "a9.grey", "b.grey", "\xc3\xa4.grey"));
}

TEST(Replay, LeavesOutTheMaskAndWhateverIsNoFrame) {
  const TemporaryFolder folder;
  const TemporaryFolder elsewhere;
  folder.write("frame.grey", grey_pixels('x'));
  folder.write("mask.png", "a copy of the mask");
  folder.write("linked.png", "the mask under another name");
  for (const char* name : {"camera.toml", "calib_results.txt", "truth.json", "timestamps.csv.bak",
                           ".hidden.grey", "README"}) {
    folder.write(name, "no frame");
  }
  std::filesystem::create_directory(folder / "folder.grey");

  ReplayOptions options = options_for(folder.path());
  options.mask = elsewhere / "mask.png";
  std::filesystem::create_hard_link(folder / "linked.png", options.mask);
  const Replayed seen = replay(options);
  EXPECT_THAT(files_of(seen), ElementsAre("frame.grey"));
  EXPECT_TRUE(seen.bad.empty());
}

TEST(Replay, CountsAndNamesBadFilesAndGoesOn) {
  const TemporaryFolder folder;
  folder.write("0.grey", grey_pixels('a'));
  folder.write("1.grey", "short");
  folder.write("2.jpg", "");
  folder.write("3.png", "no image");
  folder.write("4.grey", grey_pixels('b'));
  const Replayed seen = replay(options_for(folder.path()));
  ASSERT_THAT(files_of(seen), ElementsAre("0.grey", "4.grey"));
  EXPECT_EQ(seen.frames[1].seq, 4);
  EXPECT_EQ(seen.frames[1].utime_us, 400'000);
  EXPECT_THAT(seen.bad, ElementsAre(HasSubstr("1.grey: has 5 bytes"), HasSubstr("2.jpg: is empty"),
                                    HasSubstr("3.png: is no image")));
}

TEST(Replay, DeliversEachRawFormatByteForByte) {
  for (int i = 0; i < static_cast<int>(PixelFormat::mjpeg); ++i) {
    const auto format = static_cast<PixelFormat>(i);
    const TemporaryFolder folder;
    std::string content(packed_frame_bytes(format, kSize), '\0');
    for (std::size_t k = 0; k < content.size(); ++k) content[k] = static_cast<char>(7 * k);
    folder.write("frame." + std::string(name(format)), content);

    ReplayClock clock;
    const auto source = make_replay_source(options_for(folder.path()), clock);
    source->open();
    const Grab grab = source->grab(seconds(1));
    ASSERT_EQ(grab.kind, Grab::Kind::frame) << name(format);
    EXPECT_EQ(grab.frame.image().format, format);
    EXPECT_EQ(grab.frame.image().size, kSize);
    const Plane& chroma = grab.frame.image().planes[1];
    EXPECT_EQ(bytes_of(grab.frame) + std::string(reinterpret_cast<const char*>(chroma.bytes.data()),
                                                 chroma.bytes.size()),
              content);
  }
}

TEST(Replay, TakesAnMjpegFileOfAFolderAsOneFrameOfSuchACamera) {
  const TemporaryFolder folder;
  const std::string frame = "\xff\xd8\xff\xe0 and so on";
  folder.write("0.mjpeg", frame);
  folder.write("1.mjpeg", "no JPEG");
  const Replayed seen = replay(options_for(folder.path()));
  ASSERT_THAT(files_of(seen), ElementsAre("0.mjpeg"));
  EXPECT_THAT(seen.bad, ElementsAre(HasSubstr("1.mjpeg: does not begin as a JPEG does")));

  ReplayClock clock;
  const auto source = make_replay_source(options_for(folder.path()), clock);
  source->open();
  const Grab grab = source->grab(seconds(1));
  EXPECT_EQ(grab.frame.image().format, PixelFormat::mjpeg);
  EXPECT_EQ(bytes_of(grab.frame), frame);
}

TEST(Replay, StampsAtTenHertzOrFromTimestampsCsv) {
  const TemporaryFolder folder = folder_of(3);
  EXPECT_THAT(utimes_of(replay(options_for(folder.path()))), ElementsAre(0, 100'000, 200'000));
  folder.write("timestamps.csv",
               "file,utime_us\nf2.grey,1700000000300000\r\nf0.grey,1700000000000000\n"
               "f1.grey,1700000000100000\ngone.grey,5\n");
  EXPECT_THAT(utimes_of(replay(options_for(folder.path()))),
              ElementsAre(1'700'000'000'000'000, 1'700'000'000'100'000, 1'700'000'000'300'000));
}

TEST(Replay, RefusesDamagedTimestamps) {
  const TemporaryFolder folder = folder_of(2);
  const auto refused = [&](std::string_view table) {
    folder.write("timestamps.csv", table);
    return refusal(options_for(folder.path()));
  };
  EXPECT_THAT(refused("f0.grey,1\n"), HasSubstr("timestamps.csv: f1.grey is missing"));
  EXPECT_THAT(refused("f0.grey,1\nf1.grey\n"), HasSubstr("line 2: is not a pair"));
  EXPECT_THAT(refused("f0.grey,1\nf1.grey,2.5\n"), HasSubstr("\"2.5\" is not a time"));
  EXPECT_THAT(refused("f0.grey,1\nf1.grey,-1\n"), HasSubstr("\"-1\" is not a time"));
  EXPECT_THAT(refused("f0.grey,1\nf1.grey,9223372036854775807\n"), HasSubstr("is not a time"));
  EXPECT_THAT(refused("f0.grey,1\nf0.grey,2\n"), HasSubstr("line 2: f0.grey has a time already"));
}

TEST(Replay, RefusesWhatHoldsNoFrameInOneLine) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(options_for(folder / "absent")), HasSubstr("absent: does not exist"));
  EXPECT_THAT(refusal(options_for(folder.path())), HasSubstr("holds no frame"));
  EXPECT_THAT(refusal(options_for(folder.write("notes.txt", "x"))), HasSubstr("is no image"));
  EXPECT_THAT(refusal(options_for(folder.write("a.mp4", "x"))), HasSubstr("is no video"));
  EXPECT_THAT(refusal(options_for(folder.write("1.grey", "xyz"))),
              HasSubstr("1.grey: has 3 bytes"));
  folder.write("2.grey", "");
  EXPECT_THAT(refusal(options_for(folder.path())), HasSubstr("1.grey: has 3 bytes"));
}

TEST(Replay, LoopsWithTimeThatGoesOn) {
  const TemporaryFolder folder = folder_of(2);
  folder.write("timestamps.csv", "f0.grey,1000000\nf1.grey,1250000\n");
  ReplayOptions options = options_for(folder.path());
  options.loop = true;
  const Replayed seen = replay(options, 5);
  EXPECT_THAT(utimes_of(seen), ElementsAre(1'000'000, 1'250'000, 1'500'000, 1'750'000, 2'000'000));
  EXPECT_EQ(seen.frames[4].seq, 4);
  EXPECT_EQ(seen.frames[4].file, "f0.grey");
}

TEST(Replay, StartAndEndAreSecondsFromTheFirstFrame) {
  const TemporaryFolder folder = folder_of(6);
  ReplayOptions options = options_for(folder.path());
  options.start_s = 0.15;
  options.end_s = 0.4;
  const Replayed seen = replay(options);
  EXPECT_THAT(files_of(seen), ElementsAre("f2.grey", "f3.grey"));
  EXPECT_EQ(seen.frames[0].seq, 0);
  options.loop = true;
  EXPECT_THAT(utimes_of(replay(options, 4)), ElementsAre(200'000, 300'000, 400'000, 500'000));
  options.start_s = 9;
  options.end_s = 10;
  EXPECT_THAT(refusal(options), HasSubstr("no frame between start and end"));
  options.end_s = 1;
  EXPECT_THAT(refusal(options), HasSubstr("no span of time"));
}

TEST(Replay, LockstepSetsTheClockToEachStamp) {
  const TemporaryFolder folder = folder_of(3);
  folder.write("timestamps.csv", "f0.grey,5000000\nf1.grey,5100000\nf2.grey,99000000\n");
  ReplayClock clock;
  const auto source = make_replay_source(options_for(folder.path()), clock);
  source->open();
  for (const std::int64_t utime_us : {5'000'000, 5'100'000, 99'000'000}) {
    const Grab grab = source->grab(milliseconds(1));
    ASSERT_EQ(grab.kind, Grab::Kind::frame);
    EXPECT_EQ(clock.utc_us(), utime_us);
    EXPECT_EQ(grab.frame.stamp().mono_ns, clock.mono_ns());
  }
  EXPECT_EQ(source->grab(milliseconds(1)).kind, Grab::Kind::end);
}

TEST(Replay, RealtimeHoldsFramesBackUntilTheirTime) {
  const TemporaryFolder folder = folder_of(2);
  ReplayClock clock(1'000'000'000);
  const auto source =
      make_replay_source(options_for(folder.path(), ReplayPace::Kind::realtime), clock);
  source->open();
  EXPECT_EQ(source->grab(milliseconds(40)).frame.stamp().mono_ns, 1'000'000'000);
  EXPECT_EQ(source->grab(milliseconds(40)).kind, Grab::Kind::timeout);
  EXPECT_EQ(clock.mono_ns(), 1'040'000'000);
  EXPECT_EQ(source->grab(milliseconds(60)).frame.stamp().mono_ns, 1'100'000'000);
}

TEST(Replay, WhoComesLateInRealtimeGetsTheNewestFrame) {
  const TemporaryFolder folder = folder_of(6);
  ReplayClock clock;
  const auto source =
      make_replay_source(options_for(folder.path(), ReplayPace::Kind::realtime), clock);
  source->open();
  EXPECT_EQ(source->grab(milliseconds(1)).frame.sensor_seq(), 0);
  clock.advance_to(330'000'000);
  const Grab late = source->grab(milliseconds(1));
  EXPECT_EQ(late.frame.sensor_seq(), 3);
  EXPECT_EQ(late.drops[DropCause::superseded], 2);
  clock.advance_to(9'000'000'000);
  EXPECT_EQ(source->grab(milliseconds(1)).frame.sensor_seq(), 5) << "the last one is never skipped";
}

TEST(Replay, RateAndFastGoByTheirOwnTime) {
  const TemporaryFolder folder = folder_of(3);
  ReplayOptions options = options_for(folder.path());
  ReplayClock clock;
  options.pace = parse_replay_pace("rate:4");
  auto source = make_replay_source(options, clock);
  source->open();
  for (const std::int64_t release_ns : {0, 250'000'000, 500'000'000}) {
    EXPECT_EQ(source->grab(seconds(1)).frame.stamp().mono_ns, release_ns);
  }
  options.pace = parse_replay_pace("fast");
  source = make_replay_source(options, clock);
  source->open();
  for (const std::int64_t utime_us : {0, 100'000, 200'000}) {
    const Grab grab = source->grab(seconds(1));
    EXPECT_EQ(grab.frame.stamp().ns, utime_us * 1000);
    EXPECT_EQ(grab.frame.stamp().mono_ns, 500'000'000);
  }
}

TEST(Replay, RestampGivesTheInstantOfRelease) {
  const TemporaryFolder folder = folder_of(2);
  ReplayOptions options = options_for(folder.path(), ReplayPace::Kind::realtime);
  options.restamp = true;
  ReplayClock clock(7'000'000'000);
  const auto source = make_replay_source(options, clock);
  source->open();
  source->grab(seconds(1));
  const Grab grab = source->grab(seconds(1));
  EXPECT_EQ(grab.frame.stamp().clock, StampClock::monotonic);
  EXPECT_EQ(grab.frame.stamp().ns, 7'100'000'000);
  options.pace.kind = ReplayPace::Kind::lockstep;
  EXPECT_THAT(refusal(options), HasSubstr("--restamp"));
}

TEST(Replay, RefusesAPaceThatIsNone) {
  for (const char* text :
       {"", "slow", "rate", "rate:", "rate:0", "rate:-1", "rate:nan", "rate:1e9", "rate:5x"}) {
    EXPECT_THROW(parse_replay_pace(text), ConfigError) << text;
  }
  EXPECT_EQ(parse_replay_pace("rate:2.5").rate_hz, 2.5);
}

TEST(Replay, InterruptEndsAWait) {
  const TemporaryFolder folder = folder_of(2);
  ReplayOptions options = options_for(folder.path());
  options.pace = parse_replay_pace("rate:0.01");
  SystemClock clock;
  const auto source = make_replay_source(options, clock);
  source->open();
  ASSERT_EQ(source->grab(seconds(1)).kind, Grab::Kind::frame);
  std::thread other([&] { source->interrupt(); });
  EXPECT_EQ(source->grab(seconds(60)).kind, Grab::Kind::interrupted);
  other.join();
}

TEST(Replay, FramesOutliveTheirSource) {
  const TemporaryFolder folder = folder_of(2);
  ReplayClock clock;
  auto source = make_replay_source(options_for(folder.path()), clock);
  source->open();
  const Grab first = source->grab(seconds(1));
  const Grab second = source->grab(seconds(1));
  source->close();
  source.reset();
  EXPECT_EQ(bytes_of(first.frame), grey_pixels('a'));
  EXPECT_EQ(bytes_of(second.frame), grey_pixels('b'));
  EXPECT_EQ(second.frame.file(), "f1.grey");
}

TEST(Replay, FramesMayBeDroppedByAnotherThread) {
  const TemporaryFolder folder = folder_of(2);
  ReplayOptions options = options_for(folder.path(), ReplayPace::Kind::fast);
  options.loop = true;
  ReplayClock clock;
  const auto source = make_replay_source(options, clock);
  source->open();
  std::mutex mutex;
  std::vector<Frame> handed_over;
  std::thread other([&] {
    for (int dropped = 0; dropped < 500;) {
      std::vector<Frame> taken;
      const std::lock_guard lock(mutex);
      taken.swap(handed_over);
      for (const Frame& frame : taken) {
        EXPECT_EQ(bytes_of(frame), grey_pixels(frame.sensor_seq() % 2 == 0 ? 'a' : 'b'));
        ++dropped;
      }
    }
  });
  for (int i = 0; i < 500; ++i) {
    Grab grab = source->grab(seconds(1));
    const std::lock_guard lock(mutex);
    handed_over.push_back(std::move(grab.frame));
  }
  other.join();
}

// A picture with something in every channel.
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
                                    HasSubstr("4.png: is a PNG image that is cut short")));
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
  EXPECT_THAT(refusal(options_for(folder.path())), HasSubstr("MAX_IMAGE_PIXELS"));
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
