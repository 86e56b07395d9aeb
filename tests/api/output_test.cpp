#include "scenes.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace tumble {
namespace {

Image plain(std::uint8_t level) {
    Image image{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, level)};
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 255;
    return image;
}

TEST(Output, APngGivesTheImageBack) {
    const TestFolder folder;
    const Scene scene(crate_and_ball());
    const Image image = Renderer(scene).render(after(scene, 0));
    write_png(folder / "a.png", image);
    EXPECT_EQ(read_png(folder / "a.png"), image);
}

TEST(Output, APngKeepsAlphaIfAsked) {
    const TestFolder folder;
    const Scene scene(crate_and_ball());
    RenderOptions options;
    options.transparent = true;
    Renderer renderer(scene, options);
    const Image image = renderer.render(after(scene, 0));
    EXPECT_EQ(image.at(0, 0)[3], 0);
    write_png(folder / "a.png", image, PngAlpha::kept);
    EXPECT_EQ(read_png(folder / "a.png"), image);
    EXPECT_EQ(renderer.render_blurred(std::vector(2, after(scene, 0))), image);
    EXPECT_THROW(renderer.render_blurred(std::vector(257, after(scene, 0))), Error);
    ClipOptions clip;
    clip.transparent = true;
    EXPECT_THROW(ClipWriter(folder / "a.mp4", crate_and_ball().output, clip), Error);
    ClipWriter writer(folder / "a.webm", crate_and_ball().output, clip);
    writer.write(image);
    writer.finish();
}

TEST(Output, ComparisonTellsTheRule) {
    const Comparison same = compare_images(plain(10), plain(10));
    EXPECT_TRUE(same.alike);
    EXPECT_TRUE(same.reason.empty());
    const Comparison other = compare_images(plain(10), plain(60));
    EXPECT_FALSE(other.alike);
    EXPECT_FALSE(other.reason.empty());
    EXPECT_EQ(other.differing_pixels, 256);
    EXPECT_EQ(other.max_difference, 50);
}

TEST(Output, ComparisonOfFilesIsThatOfImages) {
    const TestFolder folder;
    Image other = plain(10);
    other.pixels[4 * (16 * 9 + 5)] = 200;
    write_png(folder / "a.png", plain(10));
    write_png(folder / "b.png", other);
    const Comparison files = compare_png_files(folder / "a.png", folder / "b.png", {}, folder / "d.png");
    EXPECT_FALSE(files.alike);
    EXPECT_EQ(files.differing_pixels, 1);
    EXPECT_EQ(files.max_difference, 190);
    EXPECT_EQ(files.max_column, 5);
    EXPECT_EQ(files.max_row, 9);
    EXPECT_EQ(files.reason, compare_images(plain(10), other).reason);
    const Image difference = read_png(folder / "d.png");
    EXPECT_GT(difference.at(5, 9)[0], difference.at(5, 9)[2]);  // red
    CompareOptions options;
    options.fraction = 0.01;
    options.window = 255.0;
    EXPECT_TRUE(compare_png_files(folder / "a.png", folder / "b.png", options).alike);
    EXPECT_EQ(folder.files(), 3u);
    options.fraction = 0.0;
    options.cluster = 1;
    EXPECT_FALSE(compare_images(plain(10), other, options).alike);  // rule pixels
    options.tolerance = 200;
    EXPECT_TRUE(compare_images(plain(10), other, options).alike);
    options.shade = 0;  // of pixels that are off by more than 100 levels
    EXPECT_FALSE(compare_images(plain(10), other, options).alike);
    options.shade = 65;
    EXPECT_THROW(compare_images(other, other, options), Error);
    options.shade.reset();
    options.tolerance = 256;
    EXPECT_THROW(compare_images(other, other, options), Error);
    EXPECT_THROW(compare_png_files(folder / "a.png", folder / "none.png"), Error);
}

TEST(Output, FilesAppearWhenFinishedOrNever) {
    const TestFolder folder;
    const Scene scene(crate_and_ball());
    {
        World world(scene);
        TrajectoryTable trajectory(folder / "t.csv", scene), left(folder / "left.csv", scene);
        EnergyTable energy(folder / "e.csv");
        ClipWriter clip(folder / "c.mkv", scene.output()), left_clip(folder / "left.mkv", scene.output());
        Renderer renderer(scene);
        const Image& image = renderer.render(world.snapshot());
        for (int i = 0; i < 3; ++i) clip.write(image);
        left_clip.write(image);
        trajectory.add(world.snapshot());
        left.add(world.snapshot());
        energy.add(0, 0.0, world.energies());
        trajectory.finish();
        energy.finish();
        clip.finish();
    }
    EXPECT_EQ(folder.files(), 3u);
    const std::string table = read_text(folder / "t.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);  // the head, the crate and the ball
    EXPECT_EQ(table.rfind("frame,time,body,x,y,z,", 0), 0u);
    EXPECT_EQ(read_text(folder / "e.csv").rfind("frame,time,kinetic,", 0), 0u);
}

}  // namespace
}  // namespace tumble
