#include "replayed.h"

#include <fstream>

namespace bole {
namespace {

using namespace test;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;

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
  EXPECT_THAT(refused("f0.grey,2\nf1.grey,1\n"), HasSubstr("f1.grey is earlier than f0.grey"));
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

}  // namespace
}  // namespace bole
