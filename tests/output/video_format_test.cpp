// Endings and frame rates, before any program runs.
#include "../support/folder.h"

#include "core/error.h"
#include "output/video_format.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <string>

namespace tumble::video_format_test {
namespace {

TEST(FrameRate, IsTheFractionMeant) {
    EXPECT_EQ(to_frame_rate(60.0), (FrameRate{60, 1}));
    EXPECT_EQ(to_frame_rate(29.97), (FrameRate{2997, 100}));
    EXPECT_EQ(to_frame_rate(30000.0 / 1001.0), (FrameRate{30000, 1001}));
    EXPECT_EQ(to_frame_rate(0.5), (FrameRate{1, 2}));
    EXPECT_EQ(to_frame_rate(1.0 / 3.0), (FrameRate{1, 3}));
    EXPECT_EQ(to_frame_rate(12.5), (FrameRate{25, 2}));
    EXPECT_EQ(to_frame_rate(1e6), (FrameRate{1000000, 1}));
    EXPECT_EQ(to_frame_rate(0.001), (FrameRate{1, 1000}));
    EXPECT_EQ(to_frame_rate(60.0).text(), "60/1");
}

TEST(FrameRate, IsCloseForAnyNumber) {
    for (double fps = 0.0013; fps < 1e6; fps *= 1.0371) {
        const FrameRate rate = to_frame_rate(fps);
        ASSERT_GE(rate.numerator, 1);
        ASSERT_GE(rate.denominator, 1);
        EXPECT_LE(rate.numerator, 1'000'000);
        EXPECT_LE(rate.denominator, 1'000'000);
        // A best fraction p/q is closer than 1/(q * limit): the worst case is a numerator at the limit.
        EXPECT_NEAR(double(rate.numerator) / double(rate.denominator), fps, fps * fps * 1e-6 + fps * 1e-6) << fps;
    }
}

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
