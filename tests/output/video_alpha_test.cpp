// Clips with alpha, encoded by the real ffmpeg and decoded again.
#include "output/process.h"
#include "output/video_writer.h"

#include "support/folder.h"
#include "support/pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <tuple>

namespace tumble::video_alpha_test {
namespace {

constexpr Pixel crate{200, 133, 60};

/// All frames as RGBA bytes. ffmpeg's own VP9 decoder ignores alpha.
std::string decoded_with_alpha(const std::filesystem::path& clip) {
    const std::filesystem::path raw = clip.string() + ".rgba";
    const char* const decoder = clip.extension() == ".webm" ? "libvpx-vp9" : "prores";
    if (!output_of("/usr/bin/ffmpeg", {"-v", "error", "-c:v", decoder, "-i", clip.string(), "-f", "rawvideo",
                                       "-pix_fmt", "rgba", "-y", raw.string()}))
        return "";
    std::string bytes = read_text(raw);
    std::filesystem::remove(raw);
    return bytes;
}

/// A box that moves over nothing, its right half half transparent.
Image glass_box(int height, int frame) {
    Image image(64, height);
    fill(image, 4 * frame + 8, 12, 24, 24, crate);
    for (int y = 12; y < 36; ++y)
        for (int x = 4 * frame + 20; x < 4 * frame + 32; ++x) image.at(x, y)[3] = 128;
    return image;
}

/// Largest differences in levels: of alpha, and of the color of covered pixels.
struct Difference {
    int alpha = 0, color = 0;
};

Difference difference(const char* rgba, const Image& image) {
    Difference most;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const int here = std::abs(int(static_cast<std::uint8_t>(rgba[i])) - image.pixels[i]);
        if (i % 4 == 3)
            most.alpha = std::max(most.alpha, here);
        else if (image.pixels[i | 3] > 0)
            most.color = std::max(most.color, here);
    }
    return most;
}

class AlphaOfClipsOfAllKinds : public testing::TestWithParam<std::tuple<const char*, int, VideoQuality>> {};

TEST_P(AlphaOfClipsOfAllKinds, IsPreserved) {
    const auto& [name, height, quality] = GetParam();
    const bool webm = name == std::string("a.webm"), draft = quality == VideoQuality::draft;
    const TestFolder folder;
    VideoWriter writer(folder / name, 64, height, 25.0, {FrameTimes::constant_rate, quality, true});
    for (int n = 0; n < 6; ++n) writer.write(glass_box(height, n));
    writer.repeat();
    writer.finish();
    const std::size_t frame_size = 4u * 64u * std::size_t(height);
    const std::string rgba = decoded_with_alpha(folder / name);
    ASSERT_EQ(rgba.size(), 7 * frame_size);
    for (const int frame : {0, 5, 6}) {
        const Difference most =
            difference(rgba.data() + std::size_t(frame) * frame_size, glass_box(height, std::min(frame, 5)));
        EXPECT_LE(most.alpha, !webm ? 1 : draft ? 24 : 8) << frame;
        EXPECT_LE(most.color, draft ? 24 : 12) << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(All, AlphaOfClipsOfAllKinds,
                         testing::Combine(testing::Values("a.webm", "a.mov"), testing::Values(48, 47),
                                          testing::Values(VideoQuality::draft, VideoQuality::normal,
                                                          VideoQuality::best)));

TEST(AlphaOfClips, ProResHasTheTagsThatEditorsNeed) {
    const TestFolder folder;
    VideoWriter writer(folder / "a.mov", 64, 48, 25.0, {FrameTimes::constant_rate, VideoQuality::normal, true});
    writer.write(glass_box(48, 0));
    writer.finish();
    const auto tags = output_of("/usr/bin/ffprobe", {"-v", "error", "-show_entries",
                                                     "stream=codec_name,profile,color_range,color_space,color_transfer",
                                                     "-of", "csv=p=0", (folder / "a.mov").string()});
    EXPECT_EQ(tags.value_or(""), "prores,4444,tv,bt709,bt709\n");
    EXPECT_EQ(folder.files(), 1u);
}

}  // namespace
}  // namespace tumble::video_alpha_test
