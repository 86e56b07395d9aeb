// Clips encoded by the real ffmpeg, measured with ffprobe and decoded again.
#include "output/video_writer.h"
#include "core/error.h"
#include "output/process.h"

#include "support/folder.h"
#include "support/pictures.h"

#include <gtest/gtest.h>

#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace tumble::video_writer_test {
namespace {

constexpr Pixel crate{200, 133, 60};

std::string probe(const std::filesystem::path& clip, const std::string& what) {
    auto text = output_of("/usr/bin/ffprobe", {"-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                                               "stream=" + what, "-of", "default=nw=1:nk=1", clip.string()});
    if (!text) return "ffprobe failed";
    for (char& c : *text)
        if (c == '\n') c = ' ';
    if (!text->empty()) text->pop_back();
    return *text;
}

/// All frames as RGB bytes, by the matrix that the clip names.
std::string decoded(const std::filesystem::path& clip) {
    const std::filesystem::path raw = clip.string() + ".rgb";
    if (!output_of("/usr/bin/ffmpeg",
                   {"-v", "error", "-i", clip.string(), "-f", "rawvideo", "-pix_fmt", "rgb24", "-y", raw.string()}))
        return "";
    std::string bytes = read_text(raw);
    std::filesystem::remove(raw);
    return bytes;
}

/// A box that moves over a uniform ground by 4 pixels per frame.
Image moving_box(int width, int height, int frame) {
    Image image = plain(width, height, {90, 100, 110});
    if (width >= 8 && height >= 8) fill(image, std::min(4 * frame, width - 8), height / 2 - 4, 8, 8, crate);
    return image;
}

void write_clip(const std::filesystem::path& clip, int width, int height, double fps, int frames) {
    std::filesystem::remove(clip);
    VideoWriter writer(clip, width, height, fps);
    for (int n = 0; n < frames; ++n) writer.write(moving_box(width, height, n));
    EXPECT_FALSE(std::filesystem::exists(clip)) << "half-written under its final name";
    writer.finish();
}

Pixel pixel_at(const std::string& rgb, int width, int height, int frame, int x, int y) {
    const std::size_t at =
        3 * ((std::size_t(frame) * std::size_t(height) + std::size_t(y)) * std::size_t(width) + std::size_t(x));
    if (at + 3 > rgb.size()) return {-1, -1, -1};
    const auto byte = [&](std::size_t i) { return int(static_cast<std::uint8_t>(rgb[at + i])); };
    return {byte(0), byte(1), byte(2)};
}

void expect_near(Pixel a, Pixel b, int levels) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], levels) << "channel " << c;
}

TEST(VideoWriter, H264HasTheFeaturesThatPlayersNeed) {
    const TestFolder folder;
    write_clip(folder / "a.mp4", 64, 48, 60.0, 12);
    EXPECT_EQ(probe(folder / "a.mp4",
                    "codec_name,width,height,pix_fmt,color_range,color_space,color_transfer,"
                    "color_primaries,avg_frame_rate,nb_read_frames"),
              "h264 64 48 yuv420p tv bt709 bt709 bt709 60/1 12");
    const std::string bytes = read_text(folder / "a.mp4");
    EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "it cannot play while it loads";
    EXPECT_EQ(folder.files(), 1u);
}

TEST(VideoWriter, ColorsAndPlacesArePreserved) {
    const TestFolder folder;
    for (const char* name : {"a.mp4", "a.mkv", "a.mov", "a.webm", "a.gif"}) {
        SCOPED_TRACE(name);
        write_clip(folder / name, 64, 48, 25.0, 10);
        const std::string rgb = decoded(folder / name);
        ASSERT_EQ(rgb.size(), 10u * 64u * 48u * 3u);
        for (const int frame : {0, 5, 9}) {
            expect_near(pixel_at(rgb, 64, 48, frame, 4 * frame + 4, 24), crate, 12);
            expect_near(pixel_at(rgb, 64, 48, frame, 60, 5), {90, 100, 110}, 4);
        }
    }
}

TEST(VideoWriter, AnyRate) {
    const TestFolder folder;
    for (const auto& [fps, text] :
         {std::pair{29.97, "2997/100"}, {0.5, "1/2"}, {1e6, "1000000/1"}, {23.976, "2997/125"}}) {
        write_clip(folder / "a.mp4", 32, 32, fps, 5);
        EXPECT_EQ(probe(folder / "a.mp4", "avg_frame_rate,nb_read_frames"), std::string(text) + " 5") << fps;
    }
}

TEST(VideoWriter, OneFrameIsAClip) {
    const TestFolder folder;
    for (const char* name : {"a.mp4", "a.webm", "a.gif"}) {
        write_clip(folder / name, 32, 32, 1e3, 1);
        EXPECT_EQ(probe(folder / name, "nb_read_frames"), "1") << name;
    }
}

TEST(VideoWriter, OddSizesRepeatTheirEdge) {
    const TestFolder folder;
    VideoWriter writer(folder / "a.mp4", 33, 17, 10.0);
    for (int n = 0; n < 3; ++n) writer.write(plain(33, 17, crate));
    writer.finish();
    EXPECT_EQ(probe(folder / "a.mp4", "width,height,nb_read_frames"), "34 18 3");
    const std::string rgb = decoded(folder / "a.mp4");
    expect_near(pixel_at(rgb, 34, 18, 1, 33, 17), crate, 5);
    expect_near(pixel_at(rgb, 34, 18, 1, 33, 0), crate, 5);

    write_clip(folder / "tiny.mp4", 1, 1, 10.0, 2);
    EXPECT_EQ(probe(folder / "tiny.mp4", "width,height"), "2 2");
    write_clip(folder / "odd.gif", 33, 17, 10.0, 2);
    EXPECT_EQ(probe(folder / "odd.gif", "width,height"), "33 17");
}

TEST(VideoWriter, AFastGifTakesEveryNthFrame) {
    const TestFolder folder;
    VideoWriter writer(folder / "a.gif", 64, 48, 60.0);
    for (int n = 0; n < 9; ++n) writer.write(moving_box(64, 48, n));
    writer.finish();
    EXPECT_EQ(writer.frames_in_clip(), 5);
    const std::string rgb = decoded(folder / "a.gif");
    expect_near(pixel_at(rgb, 64, 48, 2, 4 * 4 + 4, 24), crate, 12);  // the third shows frame 4
}

TEST(VideoWriter, TheSameFramesAreTheSameBytes) {
    const TestFolder folder;
    for (const char* ending : {".mp4", ".mkv", ".webm", ".gif"}) {
        write_clip(folder / ("a" + std::string(ending)), 64, 48, 30.0, 20);
        write_clip(folder / ("b" + std::string(ending)), 64, 48, 30.0, 20);
        EXPECT_TRUE(read_text(folder / ("a" + std::string(ending))) == read_text(folder / ("b" + std::string(ending))))
            << ending;
    }
}

/// Gray value shown at each of the times n/fps, by the time stamps of the stored frames.
std::vector<int> shown(const std::filesystem::path& clip, double fps, int frames) {
    const std::filesystem::path raw = clip.string() + ".gray";
    output_of("/usr/bin/ffmpeg", {"-v", "error", "-i", clip.string(), "-fps_mode", "passthrough", "-f", "rawvideo",
                                  "-pix_fmt", "gray", "-y", raw.string()});
    const std::string bytes = read_text(raw);
    std::istringstream times(
        *output_of("/usr/bin/ffprobe", {"-v", "error", "-select_streams", "v", "-show_entries", "frame=pts_time", "-of",
                                        "default=nw=1:nk=1", clip.string()}));
    std::vector<int> greys;
    double time = 0.0;
    for (std::size_t at = 0; times >> time && at < bytes.size(); at += 64 * 48) {
        const auto first = static_cast<std::size_t>(std::llround(time * fps));
        EXPECT_NEAR(double(first), time * fps, 0.1);
        if (!greys.empty()) greys.resize(first, greys.back());
        greys.push_back(static_cast<std::uint8_t>(bytes[at]));
    }
    EXPECT_EQ(greys.size(), std::size_t(frames));
    greys.resize(std::size_t(frames));
    return greys;
}

TEST(VideoWriter, UnchangedPicturesAreStoredOnceAndShownLonger) {
    const TestFolder folder;
    // Value and frame of each change; the last one stays to the end.
    const std::vector<std::pair<int, int>> changes{{0, 40}, {1, 60}, {5, 80}, {6, 100}, {7, 120}, {12, 140}, {45, 200}};
    constexpr int frames = 60;
    for (const char* name : {"a.mp4", "a.mkv", "a.webm", "a.gif"}) {
        SCOPED_TRACE(name);
        std::vector<int> expected;
        for (const FrameTimes times : {FrameTimes::longer_frames, FrameTimes::constant_rate}) {
            VideoWriter writer(folder / name, 64, 48, 25.0, {times});
            expected.clear();
            std::size_t next = 0;
            for (int n = 0; n < frames; ++n) {
                if (next < changes.size() && changes[next].first == n) {
                    const int grey = changes[next++].second;
                    writer.write(plain(64, 48, {grey, grey, grey}));
                    expected.push_back(grey);
                } else {
                    writer.repeat();
                    expected.push_back(expected.back());
                }
            }
            writer.finish();
            // Frame 37 is sent again after a second, frame 59 is the last.
            const std::int64_t stored = times == FrameTimes::longer_frames ? 9 : frames;
            EXPECT_EQ(writer.frames_in_clip(), frames);
            EXPECT_EQ(writer.frames_stored(), stored);
            if (times == FrameTimes::longer_frames || std::string(name) != "a.gif") {
                EXPECT_EQ(probe(folder / name, "nb_read_frames"), std::to_string(stored));
            }
            const std::vector<int> greys = shown(folder / name, 25.0, frames);
            for (std::size_t n = 0; n < greys.size(); ++n) EXPECT_NEAR(greys[n], expected[n], 3) << n;
            if (std::string(name) == "a.mp4") {
                EXPECT_EQ(probe(folder / name, "r_frame_rate,duration"), "25/1 2.400000");
            }
        }
    }
}

TEST(VideoWriter, AFastGifKeepsItsShownFrames) {
    // The GIF takes every second one of 100 frames/s: content of the other frames must not appear.
    const TestFolder folder;
    VideoWriter writer(folder / "a.gif", 64, 48, 100.0);
    const Image dark = plain(64, 48, {40, 40, 40}), bright = plain(64, 48, {200, 200, 200});
    for (int n = 0; n < 6; ++n) {  // clip frames 0 to 5: dark, dark, bright, bright, dark, dark
        writer.write(n / 2 == 1 ? bright : dark);
        writer.repeat();
    }
    writer.write(dark);
    writer.write(bright);  // frame 13: not in the clip
    writer.finish();
    EXPECT_EQ(writer.frames_in_clip(), 7);
    const std::vector<int> greys = shown(folder / "a.gif", 50.0, 7);
    for (std::size_t n = 0; n < 7; ++n) EXPECT_NEAR(greys[n], n == 2 || n == 3 ? 200 : 40, 6) << n;
}

TEST(VideoWriter, StrangeNamesAreNames) {
    const TestFolder folder;
    for (const char* name : {"-y.mp4", "http:x.mp4", "a %d 'b' \"c\" $HOME;.mp4"}) {
        write_clip(folder / name, 32, 32, 10.0, 2);
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    }
}

TEST(VideoWriter, AbandonedItLeavesNothing) {
    const TestFolder folder;
    write_text(folder / "a.gif", "old");
    {
        VideoWriter writer(folder / "a.gif", 64, 48, 30.0);
        writer.write(moving_box(64, 48, 0));
    }
    {
        VideoWriter writer(folder / "a.gif", 64, 48, 30.0);
        writer.abandon();
        EXPECT_THROW(writer.finish(), RunError);
    }
    EXPECT_EQ(read_text(folder / "a.gif"), "old");
    EXPECT_EQ(folder.files(), 1u);
}

/// Tilted squares with frames and grooves fall in front of a sky, which alone is visible at the end.
Image falling_squares(int width, int height, int frame) {
    Image image = plain(width, height, {0, 0, 0});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            fill(image, x, y, 1, 1, {110 + 60 * y / height, 150 + 50 * y / height, 205 + 25 * y / height});
    const Pixel colors[] = {crate, {47, 127, 134}, {181, 82, 59}, {232, 220, 196}, {77, 106, 143}};
    for (int i = 0; i < 40; ++i) {
        const double side = 9.0 + i * 7 % 11, turn = 0.7 * i + 0.05 * (i % 3 - 1) * frame;
        const double middle_x = i * 53 % width, middle_y = -20.0 - i * 29 % 150 + (3.0 + i * 13 % 8 * 0.4) * frame;
        const double c = std::cos(turn), s = std::sin(turn);
        for (int y = std::max(0, int(middle_y) - 30); y < std::min(height, int(middle_y) + 30); ++y)
            for (int x = std::max(0, int(middle_x) - 30); x < std::min(width, int(middle_x) + 30); ++x) {
                const double dx = x - middle_x, dy = y - middle_y;
                const double off = std::max(std::abs(dx * c + dy * s), std::abs(dy * c - dx * s)) / side;
                Pixel color = colors[i % 5];
                if (std::abs(off - 0.8) < 0.06)
                    for (int& channel : color) channel = channel * 7 / 10;
                if (off < 1.0) fill(image, x, y, 1, 1, color);
            }
    }
    return image;
}

/// Number of channels of the last frame, a second after the last movement, that are off by more than `levels`.
int still_off(const std::filesystem::path& clip, VideoQuality quality, int levels) {
    constexpr int width = 320, height = 176, falling = 110, fps = 60;
    VideoWriter writer(clip, width, height, fps, {FrameTimes::constant_rate, quality});
    Image frame;
    for (int n = 0; n < falling; ++n) writer.write(frame = falling_squares(width, height, n));
    EXPECT_EQ(frame, falling_squares(width, height, 100 * falling)) << "something is still in the picture";
    for (int n = 0; n < fps; ++n) writer.repeat();
    writer.finish();
    const std::string rgb = decoded(clip);
    int off = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Pixel shown = pixel_at(rgb, width, height, falling + fps - 1, x, y);
            for (std::size_t c = 0; c < 3; ++c) off += std::abs(shown[c] - int(frame.at(x, y)[c])) > levels ? 1 : 0;
        }
    return off;
}

TEST(VideoWriter, AStillBackgroundHealsWithinASecond) {
    const TestFolder folder;
    for (const char* name : {"a.mp4", "a.webm"})
        EXPECT_EQ(still_off(folder / name, VideoQuality::normal, 8), 0) << name;
    EXPECT_EQ(still_off(folder / "a.mp4", VideoQuality::best, 4), 0);
    EXPECT_GT(still_off(folder / "a.mp4", VideoQuality::draft, 8), 0) << "the test shows nothing";
}

/// A PATH with this script as its ffmpeg, or with none.
class OtherFfmpeg {
public:
    explicit OtherFfmpeg(const std::string& script) : before_(std::getenv("PATH")) {
        if (!script.empty()) {
            write_text(folder_ / "ffmpeg", "#!/bin/sh\n" + script);
            std::filesystem::permissions(folder_ / "ffmpeg", std::filesystem::perms::owner_all);
        }
        setenv("PATH", (folder_ / "").c_str(), 1);
    }
    ~OtherFfmpeg() { setenv("PATH", before_.c_str(), 1); }
    OtherFfmpeg(const OtherFfmpeg&) = delete;
    OtherFfmpeg& operator=(const OtherFfmpeg&) = delete;

private:
    std::string before_;
    TestFolder folder_;
};

std::string error_of_writing(const std::filesystem::path& clip, int width = 640, int height = 480) {
    try {
        VideoWriter writer(clip, width, height, 30.0);
        for (int n = 0; n < 20; ++n) writer.write(moving_box(width, height, n));
        writer.finish();
    } catch (const RunError& error) {
        return error.what();
    }
    return "";
}

TEST(VideoWriter, NoFfmpegSaysHowToGetIt) {
    const TestFolder folder;
    const OtherFfmpeg none("");
    EXPECT_NE(error_of_writing(folder / "a.mp4").find("apt-get install ffmpeg"), std::string::npos);
    EXPECT_EQ(folder.files(), 0u);
}

TEST(VideoWriter, ItsFailureIsReportedWithItsMessage) {
    const TestFolder folder;
    for (const char* script : {"echo 'no such encoder' >&2; exit 3", "exec <&-; echo 'no such encoder' >&2; exit 3",
                               "/bin/cat > /dev/null; echo 'no such encoder' >&2; exit 3"}) {
        const OtherFfmpeg broken(script);
        const std::string error = error_of_writing(folder / "a.mp4");
        EXPECT_NE(error.find("a.mp4': /"), std::string::npos) << error;
        EXPECT_NE(error.find("/ffmpeg failed (exit code 3):\nno such encoder"), std::string::npos) << error;
        EXPECT_EQ(folder.files(), 0u);
    }
}

// Exit code 0 is not sufficient; the clip is checked.
TEST(VideoWriter, AClipThatIsNotWholeIsAnError) {
    const TestFolder folder, other;
    write_clip(other / "short.mp4", 64, 48, 30.0, 4);
    // The last of its arguments is "file:NAME".
    const std::string out = "/bin/cat > /dev/null; for last; do :; done; out=${last#file:}; ";
    const std::string real = "for last; do :; done; out=${last#file:}; /usr/bin/ffmpeg \"$@\" || exit; ";
    for (const char* name : {"a.mp4", "a.mov", "a.mkv", "a.webm", "a.gif"}) {
        const bool same_kind = std::string(name) == "a.mp4" || std::string(name) == "a.mov";
        for (const auto& [script, reason] :
             {std::pair<std::string, std::string>{"/bin/cat > /dev/null; echo 'all is well' >&2", "the file is empty"},
              {out + "/bin/rm \"$out\"", "cannot be read: No such file"},
              {out + "echo hello there > \"$out\"", "it is of another kind"},
              {out + "/bin/cp " + (other / "short.mp4").string() + " \"$out\"",
               same_kind ? "it has 4 frames of 20" : "it is of another kind"},
              {real + "/usr/bin/truncate -s -1 \"$out\"", "the file ends too early"},
              {real + "/usr/bin/truncate -s 100 \"$out\"", "the file ends too early"}}) {
            SCOPED_TRACE(std::string(name) + ": " + script);
            const OtherFfmpeg broken(script);
            const std::string error = error_of_writing(folder / name, 64, 48);
            EXPECT_NE(error.find("cannot write '"), std::string::npos) << error;
            EXPECT_NE(error.find("/ffmpeg ended with exit code 0, but the clip is not whole: "), std::string::npos)
                << error;
            EXPECT_NE(error.find(reason), std::string::npos) << error;
            EXPECT_EQ(error.ends_with(":\nall is well"), script.find("all is well") != std::string::npos) << error;
            EXPECT_EQ(folder.files(), 0u);
        }
    }
}

// A clip written into a pipe cannot be checked, so ffmpeg's own report counts.
TEST(VideoWriter, AClipIntoAPipeThatIsNotWholeIsAnError) {
    const TestFolder folder;
    for (const char* name : {"a.mkv", "a.webm", "a.gif"}) {
        ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
        for (const bool whole : {true, false}) {
            std::string got;
            std::thread reader([&] { got = read_text(folder / name); });
            const OtherFfmpeg ffmpeg(
                whole ? "exec /usr/bin/ffmpeg \"$@\""
                      : "case \"$*\" in *libx264rgb*) exec /usr/bin/ffmpeg \"$@\" ;; esac; /bin/cat > /dev/null");
            const std::string error = error_of_writing(folder / name, 64, 48);
            reader.join();
            EXPECT_EQ(error.empty(), whole) << error;
            EXPECT_EQ(got.empty(), !whole);
            EXPECT_EQ(error.find("/ffmpeg ended with exit code 0, but it reports no end") != std::string::npos, !whole)
                << error;
        }
    }
    EXPECT_EQ(folder.files(), 3u);
}

// The second run of ffmpeg, from the lossless frames to the GIF.
TEST(VideoWriter, AGifThatIsNotWholeIsAnError) {
    const TestFolder folder;
    const OtherFfmpeg broken("case \"$*\" in *palettegen*) exit 0 ;; esac; exec /usr/bin/ffmpeg \"$@\"");
    EXPECT_NE(error_of_writing(folder / "a.gif").find("the file is empty"), std::string::npos);
    EXPECT_EQ(folder.files(), 0u);
}

TEST(VideoWriter, ChildrenOfFfmpegAreNotWaitedFor) {
    const TestFolder folder, other;
    for (const char* name : {"a.mp4", "a.gif"}) {
        const OtherFfmpeg daemon("/bin/sleep 1000 & echo $! >> '" + (other / "left").string() +
                                 "'; exec /usr/bin/ffmpeg \"$@\"");
        EXPECT_EQ(error_of_writing(folder / name), "");
    }
    EXPECT_EQ(folder.files(), 2u);
    std::istringstream left(read_text(other / "left"));
    int count = 0;
    for (pid_t id = 0; left >> id; ++count) EXPECT_EQ(kill(id, SIGKILL), 0);
    EXPECT_EQ(count, 3);
}

// A stopped program takes no more frames, and reacts to no signal but the one that kills it.
TEST(VideoWriter, AStoppedFfmpegCanBeAbandoned) {
    const TestFolder folder;
    const OtherFfmpeg stopped("/bin/sleep 1000 & kill -STOP $$");
    VideoWriter writer(folder / "a.mp4", 640, 480, 30.0);
    std::thread giving_up([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        writer.abandon();
    });
    EXPECT_THROW(
        {
            for (int n = 0; n < 20; ++n) writer.write(moving_box(640, 480, n));
            writer.finish();
        },
        RunError);
    giving_up.join();
}

TEST(VideoWriter, AFolderThatIsNotThereIsNamed) {
    const TestFolder folder;
    EXPECT_NE(error_of_writing(folder / "no/a.mp4").find("no/a.mp4': No such file"), std::string::npos);
}

}  // namespace
}  // namespace tumble::video_writer_test
