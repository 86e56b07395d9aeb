// Endings and frame rates, before any program runs.
#include "support/folder.h"

#include "core/error.h"
#include "output/video_format.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <limits>
#include <string>

namespace tumble::video_format_test {
namespace {

// Only clips whose header can be written first.
TEST(VideoFormat, DependsOnTheKindOfThePath) {
    const TestFolder folder;
    for (const char* name : {"a.mp4", "a.MOV", "a.mkv", "a.webm", "a.gif"}) {
        ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
        std::filesystem::create_symlink(folder / name, folder / ("link" + std::string(name)));
        const bool head_last = name == std::string("a.mp4") || name == std::string("a.MOV");
        for (const std::string before : {"", "link"}) {
            if (head_last)
                EXPECT_THROW(video_format(folder / (before + name), 25.0), InputError) << before << name;
            else
                EXPECT_NO_THROW(video_format(folder / (before + name), 25.0)) << before << name;
        }
    }
}

TEST(VideoFormat, ByEnding) {
    EXPECT_EQ(video_format("a.mp4", 60.0).kind, VideoKind::h264);
    EXPECT_EQ(video_format("a.MP4", 60.0).kind, VideoKind::h264);
    EXPECT_EQ(video_format("a.mov", 60.0).kind, VideoKind::h264);
    EXPECT_EQ(video_format("b/a.mkv", 60.0).kind, VideoKind::h264);
    EXPECT_EQ(video_format("a.webm", 60.0).kind, VideoKind::vp9);
    EXPECT_EQ(video_format("a.gif", 25.0).kind, VideoKind::gif);
    for (const char* name : {"a", "a.avi", "mp4", "a.mp4.png", "a.", ""})
        EXPECT_THROW(video_format(name, 60.0), InputError);
}

TEST(VideoFormat, WithAlpha) {
    EXPECT_EQ(video_format("a.webm", 60.0, true).kind, VideoKind::vp9_alpha);
    EXPECT_EQ(video_format("a.MOV", 60.0, true).kind, VideoKind::prores_4444);
    for (const char* name : {"a.mp4", "a.mkv", "a.gif"}) try {
            video_format(name, 25.0, true);
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            const std::string text = error.what();
            EXPECT_NE(text.find(".webm"), std::string::npos) << text;
            EXPECT_NE(text.find(".mov"), std::string::npos) << text;
            EXPECT_NE(text.find("--frames"), std::string::npos) << text;
        }
}

TEST(VideoFormat, ImpossibleRatesAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const double fps : {0.0, -1.0, 1e-5, 1.1e6, nan, infinity})
        EXPECT_THROW(video_format("a.mp4", fps), InputError);
    EXPECT_NO_THROW(video_format("a.mp4", 1e6));
    EXPECT_NO_THROW(video_format("a.mkv", 1000.0));
    EXPECT_THROW(video_format("a.mkv", 1001.0), InputError);
    EXPECT_THROW(video_format("a.webm", 1e6), InputError);
}

TEST(VideoFormat, OddSizesGrowInH264Alone) {
    EXPECT_EQ(stored_size(VideoKind::h264, {161, 121}), (ImageSize{162, 122}));
    EXPECT_EQ(stored_size(VideoKind::h264, {160, 120}), (ImageSize{160, 120}));
    for (const VideoKind kind : {VideoKind::vp9, VideoKind::gif, VideoKind::vp9_alpha, VideoKind::prores_4444})
        EXPECT_EQ(stored_size(kind, {161, 121}), (ImageSize{161, 121}));
    EXPECT_EQ(size_text(VideoKind::h264, {160, 120}), "160 x 120");
    EXPECT_EQ(size_text(VideoKind::h264, {1, 2}), "2 x 2 (1 x 2 with the last column twice: H.264 has even sizes)");
}

TEST(VideoFormat, FractionsAreExact) {
    for (const char* clip : {"a.mp4", "a.mkv", "a.webm"})
        EXPECT_EQ(video_format(clip, 24000.0 / 1001.0).rate, (FrameRate{24000, 1001}));
    EXPECT_EQ(video_format("a.gif", 60000.0 / 1001.0).rate, (FrameRate{30000, 1001}));
}

TEST(VideoFormat, AGifLeavesFramesOutEvenly) {
    EXPECT_EQ(video_format("a.gif", 50.0).frame_step, 1);
    const VideoFormat format = video_format("a.gif", 60.0);
    EXPECT_EQ(format.frame_step, 2);
    EXPECT_EQ(format.rate, (FrameRate{30, 1}));
    EXPECT_EQ(video_format("a.gif", 1e6).frame_step, 20000);
    EXPECT_EQ(video_format("a.mp4", 1e6).frame_step, 1);
}

}  // namespace
}  // namespace tumble::video_format_test
