// The layout of frames, and text and plot on them.
#include "app/composition/frame_composer.h"
#include "app/composition/make_composition.h"
#include "app/composition/stamp.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

namespace tumble::composition_test {
namespace {

bool inside(const Rectangle& part, const Rectangle& whole) { return intersection(part, whole) == part; }

TEST(FrameLayout, PanelsLabelsAndPlotShareTheFrameWithoutOverlap) {
    for (const std::size_t panels : {1u, 2u, 3u, 4u, 5u, 9u})
        for (const auto arrangement : {PanelArrangement::automatic, PanelArrangement::row, PanelArrangement::grid})
            for (const auto place : {PlotPlace::beside, PlotPlace::below}) {
                const LayoutRequest request{1281, 719, panels, arrangement, true, true, true, true, place, 2};
                const FrameLayout layout = lay_out(request);
                ASSERT_EQ(layout.panels.size(), panels);
                EXPECT_EQ(layout.plots.size(), place == PlotPlace::below ? 2u : 1u);
                std::vector<Rectangle> all = layout.panels;
                all.insert(all.end(), layout.labels.begin(), layout.labels.end());
                all.insert(all.end(), layout.plots.begin(), layout.plots.end());
                if (panels > 1) all.insert(all.end(), {layout.header, layout.captions, layout.footer});
                for (std::size_t i = 0; i < all.size(); ++i) {
                    EXPECT_TRUE(inside(all[i], {0, 0, 1281, 719})) << panels << ' ' << i;
                    EXPECT_GT(all[i].width * all[i].height, 0);
                    for (std::size_t k = 0; k < i; ++k)
                        EXPECT_EQ(intersection(all[i], all[k]).width, 0) << i << ' ' << k;
                }
                if (panels > 1)
                    for (const Rectangle& p : layout.panels) {
                        EXPECT_EQ((p.x | p.y | p.width | p.height) % 2, 0);
                        EXPECT_EQ(p.width, layout.panels[0].width);
                        EXPECT_EQ(p.height, layout.panels[0].height);
                    }
            }
}

TEST(FrameLayout, RowsAndGrids) {
    const auto rows_of = [](std::size_t panels, PanelArrangement arrangement) {
        const FrameLayout layout = lay_out({1280, 720, panels, arrangement, false, false, false, false, {}, 1});
        int rows = 1;
        for (std::size_t i = 1; i < panels; ++i) rows += layout.panels[i].y != layout.panels[i - 1].y;
        return rows;
    };
    EXPECT_EQ(rows_of(3, PanelArrangement::automatic), 1);
    EXPECT_EQ(rows_of(4, PanelArrangement::automatic), 2);
    EXPECT_EQ(rows_of(7, PanelArrangement::automatic), 3);
    EXPECT_EQ(rows_of(4, PanelArrangement::row), 1);
    EXPECT_EQ(rows_of(2, PanelArrangement::grid), 1);
    EXPECT_EQ(rows_of(3, PanelArrangement::grid), 2);
}

TEST(FrameLayout, AnInsetIsForASinglePanel) {
    const FrameLayout one = lay_out({1280, 720, 1, {}, false, false, false, false, PlotPlace::inset, 1});
    EXPECT_EQ(one.panels[0], (Rectangle{0, 0, 1280, 720}));
    EXPECT_TRUE(one.plots_on_picture);
    EXPECT_TRUE(inside(one.plots[0], one.panels[0]));
    const FrameLayout two = lay_out({1280, 720, 2, {}, false, false, false, false, PlotPlace::inset, 1});
    EXPECT_FALSE(two.plots_on_picture);
    for (const Rectangle& panel : two.panels) EXPECT_EQ(intersection(panel, two.plots[0]).width, 0);
}

TEST(FrameLayout, TooSmallFramesAreRefused) {
    EXPECT_THROW(lay_out({200, 100, 9, {}, false, false, false, false, {}, 1}), InputError);
    EXPECT_THROW(lay_out({300, 200, 1, {}, false, false, false, false, PlotPlace::beside, 1}), InputError);
    EXPECT_NO_THROW(lay_out({20, 10000, 1, {}, false, false, false, false, {}, 1}));
}

// The panel shows everything up to the edges of the scene's frame: with t = tan(fov / 2), the half width of the
// view at distance 1 is t width / height.
TEST(PanelScene, ShowsTheWholeViewOfTheScene) {
    SceneDescription scene;
    scene.output.width = 1280;
    scene.output.height = 720;
    scene.camera.vertical_fov = 40.0;
    scene.camera.keyframes = {{0.0, {}, {}, 40.0}, {1.0, {}, {}, 60.0}};
    const auto half = [](double fov) { return std::tan(0.5 * fov * std::numbers::pi / 180.0); };
    const SceneDescription narrow = panel_scene(scene, 400, 600), wide = panel_scene(scene, 600, 200);
    EXPECT_NEAR(half(narrow.camera.vertical_fov) * 400 / 600, half(40.0) * 1280 / 720, 1e-12);
    EXPECT_NEAR(half(narrow.camera.keyframes[1].vertical_fov) * 400 / 600, half(60.0) * 1280 / 720, 1e-12);
    EXPECT_EQ(wide.camera.vertical_fov, 40.0);
    EXPECT_EQ(narrow.output.width, 400);
    scene.camera.vertical_fov = 150.0;
    EXPECT_LT(panel_scene(scene, 100, 900).camera.vertical_fov, 180.0);
}

/// A panel with a pattern that differs for each frame.
Image panel_at(int frame, int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int moved = x > width / 2 ? frame : 0;
            const std::uint8_t pixel[] = {std::uint8_t(x + 7 * moved), std::uint8_t(y), std::uint8_t(x * y), 255};
            std::copy_n(pixel, 4, image.at(x, y));
        }
    return image;
}

TEST(Fade, BrightensAtTheStartAndDarkensToTheLastFrame) {
    const ClipFade fade{0.5, 1.0, 4.0};
    EXPECT_EQ(fade.share_at(0.0), 0);
    EXPECT_EQ(fade.share_at(0.25), 128);
    for (const double time : {0.5, 1.7, 3.0}) EXPECT_EQ(fade.share_at(time), 256);
    EXPECT_EQ(fade.share_at(3.75), 64);
    EXPECT_EQ(fade.share_at(4.0), 0);
    EXPECT_EQ(ClipFade{}.share_at(0.0), 256);
}

TEST(Fade, AFrameDoesNotDependOnTheOneBefore) {
    SceneDescription scene;
    scene.output.width = 64;
    scene.output.height = 36;
    Composition composition(scene);
    composition.fade = {0.5, 0.5, 2.0};
    EXPECT_FALSE(composition.plain());
    EXPECT_TRUE(composition.changes(0.1, 0.2));
    EXPECT_FALSE(composition.changes(0.9, 1.0));
    for (const bool transparent : {false, true}) {
        FrameComposer one(composition, transparent);
        for (int frame = 0; frame <= 8; ++frame) {
            const Image panel = panel_at(frame, 64, 36);
            const std::vector<Rectangle> right{{32, 0, 32, 36}}, all{{0, 0, 64, 36}};
            const PanelImage partly{panel, right}, wholly{panel, all};
            one.compose({&partly, 1}, 0.25 * frame);
            FrameComposer fresh(composition, transparent);
            fresh.compose({&wholly, 1}, 0.25 * frame);
            EXPECT_TRUE(one.image() == fresh.image()) << frame;
            EXPECT_EQ(one.image() == panel, frame >= 2 && frame <= 6) << frame;
            EXPECT_EQ(one.image().at(40, 20)[3], frame == 0 || frame == 8   ? (transparent ? 0 : 255)
                                                 : frame == 1 || frame == 7 ? (transparent ? 128 : 255)
                                                                            : 255);
        }
    }
}

Composition with_everything() {
    SceneDescription scene;
    scene.title = "A title";
    scene.output.width = 640;
    scene.output.height = 360;
    scene.overlay.show.add(Overlay::title);
    scene.overlay.show.add(Overlay::clock);
    scene.overlay.show.add(Overlay::mode);
    scene.overlay.captions = {{"The first caption", 0.1, 0.45}, {"The second one", 0.3, 0.6}};
    const auto one = std::make_shared<const SceneDescription>(scene);
    const std::vector<ClipScene> scenes{{one, "left", {}}, {one, "right", {}}};
    Composition composition = make_composition(scenes, {{}, 1, PlotPlace::below, 1.0});
    composition.plots[0].figure.panels = {{"y (m)", false, {{"left", {0.0, 0.5, 1.0}, {0.0, 1.0, 0.5}, 0, false}}}};
    return composition;
}

struct Composed {
    Image image;
    std::vector<Rectangle> changed;
};

class Composing {
public:
    explicit Composing(const Composition& composition) : composition_(composition), composer_(composition, false) {}

    /// Frame n, at n / 10 s. The pattern of the panels changes in frames 0, 3, 6 and so on.
    Composed frame(int n) {
        std::vector<Image> images;
        std::vector<std::vector<Rectangle>> changed;
        for (const ClipPanel& panel : composition_.panels) {
            const int width = panel.place.width, height = panel.place.height;
            images.push_back(panel_at(n / 3, width, height));
            changed.emplace_back();
            if (n / 3 != last_ / 3) changed.back().push_back({width / 2, 0, width - width / 2, height});
        }
        last_ = n;
        std::vector<PanelImage> panels;
        for (std::size_t i = 0; i < images.size(); ++i) panels.push_back({images[i], changed[i]});
        composer_.compose(panels, n / 10.0);
        return {composer_.image(), composer_.changed()};
    }

private:
    Composition composition_;
    FrameComposer composer_;
    int last_ = 0;
};

TEST(FrameComposer, AFrameDoesNotDependOnTheFramesBefore) {
    const Composition composition = with_everything();
    Composing forward(composition), skipping(composition);
    for (int n = 0; n <= 10; ++n) {
        const Image expected = Composing(composition).frame(n).image;
        EXPECT_TRUE(forward.frame(n).image == expected) << n;
        if (n % 4 == 0) {
            EXPECT_TRUE(skipping.frame(n).image == expected) << n;
        }
    }
}

TEST(FrameComposer, PixelsChangeOnlyInTheChangedRegions) {
    Composing composing(with_everything());
    Image before = composing.frame(0).image;
    for (int n = 1; n <= 10; ++n) {
        Composed after = composing.frame(n);
        std::int64_t area = 0;
        for (const Rectangle& r : after.changed) {
            area += r.width * r.height;
            for (int y = r.y; y < r.y + r.height; ++y)
                for (int x = r.x; x < r.x + r.width; ++x) std::copy_n(after.image.at(x, y), 4, before.at(x, y));
        }
        EXPECT_TRUE(before == after.image) << n;
        if (n % 3 == 1 && n > 6) {
            EXPECT_LT(area, 640 * 360 / 20) << n;  // the clock and the cursor
        }
        before = std::move(after.image);
    }
    EXPECT_TRUE(composing.frame(10).changed.empty());
}

TEST(FrameComposer, TheClockIsTheOnlyDifferenceOfTwoTimes) {
    SceneDescription scene;
    scene.output.width = 640;
    scene.output.height = 360;
    scene.overlay.show.add(Overlay::clock);
    const auto one = std::make_shared<const SceneDescription>(scene);
    Composing composing(make_composition(std::vector<ClipScene>{{one, "", {}}}, {{}, 0, {}, 2.0}));
    const Image first = composing.frame(0).image;
    const Composed second = composing.frame(1);
    EXPECT_FALSE(first == second.image);
    int differing = 0;
    for (int y = 0; y < 360; ++y)
        for (int x = 0; x < 640; ++x)
            if (!std::equal(first.at(x, y), first.at(x, y) + 4, second.image.at(x, y))) {
                ++differing;
                EXPECT_TRUE(x > 400 && y < 60) << x << ' ' << y;
            }
    EXPECT_GT(differing, 20);
    EXPECT_LT(differing, 400);  // one digit: those of one width stay in place
}

TEST(Text, StaysInsideItsArea) {
    const std::string words =
        "Some words of different lengths, incomprehensibilities included, in two paragraphs.\nThe end.";
    for (const int width : {8, 40, 200, 1000})
        for (const int height : {4, 30, 300}) {
            const Rectangle area{13, 17, width, height};
            const Stamp stamp = set_text(words, {area, 0.5, 1.0, 30.0, {}, false, true, {}});
            EXPECT_TRUE(inside(stamp.box, area)) << width << ' ' << height;
            EXPECT_EQ(stamp.pixels.width, stamp.box.width);
        }
    // A long word is set smaller, not cut: the ground has its margin at the right.
    const Stamp small = set_text("Incomprehensibilities", {{0, 0, 150, 60}, 0.0, 0.0, 30.0, {}, false, true, {}});
    EXPECT_GT(small.box.width, 120);
    const std::uint8_t* const ground = small.pixels.at(small.box.width / 2, 1);
    for (int y = small.box.height / 3; y < small.box.height / 2; ++y)
        for (int x = small.box.width - 4; x < small.box.width - 1; ++x)
            EXPECT_TRUE(std::equal(ground, ground + 4, small.pixels.at(x, y))) << x << ' ' << y;
}

TEST(Plot, TheWholeCursorIsDrawn) {
    const Composition composition = with_everything();
    PlotLayer plot(composition.plots[0]);
    std::vector<Rectangle> changed;
    plot.update(0.5, changed);
    std::vector<const Stamp*> stamps;
    plot.add_stamps(stamps);
    ASSERT_EQ(stamps.size(), 2u);
    const Image& cursor = stamps[1]->pixels;
    int left = cursor.width, right = -1;
    for (int y = 0; y < cursor.height; ++y)
        for (int x = 0; x < cursor.width; ++x)
            if (cursor.at(x, y)[3] > 0) left = std::min(left, x), right = std::max(right, x);
    EXPECT_NEAR(right - left + 1, 2.0 * cursor_dot * composition.plots[0].figure.text_size, 2.0);
    EXPECT_GT(left, 0);
    EXPECT_LT(right, cursor.width - 1);
}

TEST(Text, ALongTitleEndsBeforeTheClockAndAnInsetPlot) {
    SceneDescription scene;
    scene.output.width = 640;
    scene.output.height = 360;
    scene.overlay.show.add(Overlay::title);
    scene.overlay.show.add(Overlay::clock);
    int widest = 0;
    for (int words = 1; words < 40; ++words) {
        scene.title += "words ";
        const auto one = std::make_shared<const SceneDescription>(scene);
        const std::size_t plot_panels = words % 2;
        const Composition composition =
            make_composition(std::vector<ClipScene>{{one, "", {}}}, {{}, plot_panels, PlotPlace::inset, 1.0});
        TextLayer text(composition);
        std::vector<Rectangle> changed;
        text.update(0.0, changed);
        std::vector<const Stamp*> stamps;
        text.add_stamps(stamps);
        ASSERT_EQ(stamps.size(), 2u);
        EXPECT_EQ(intersection(stamps[0]->box, stamps[1]->box).width, 0) << words;
        widest = std::max(widest, stamps[0]->box.width);
        for (const ClipPlot& plot : composition.plots)
            for (const Stamp* stamp : stamps) EXPECT_EQ(intersection(stamp->box, plot.place).width, 0) << words;
    }
    EXPECT_GT(widest, 400);
}

TEST(Composition, ChangesWithTheTextOnly) {
    const Composition composition = with_everything();
    Composition captions = composition;
    captions.plots.clear();
    captions.text.clock = false;
    EXPECT_TRUE(captions.changes(0.0, 0.1));
    EXPECT_FALSE(captions.changes(0.1, 0.25));
    EXPECT_TRUE(captions.changes(0.25, 0.35));
    EXPECT_FALSE(captions.changes(0.6, 5.0));
    captions.text.clock = true;
    EXPECT_TRUE(captions.changes(0.6, 0.601));
    EXPECT_FALSE(captions.changes(0.6, 0.6));
    SceneDescription scene;
    scene.output.width = 64;
    EXPECT_TRUE(Composition(scene).plain());
    EXPECT_FALSE(Composition(scene).changes(0.0, 1.0));
    EXPECT_FALSE(composition.plain());
}

TEST(Composition, NamesTheModeThatAllScenesShare) {
    SceneDescription scene;
    scene.output.width = 640;
    scene.output.height = 360;
    scene.overlay.show.add(Overlay::mode);
    const auto first = std::make_shared<const SceneDescription>(scene);
    scene.simulation.integrator = IntegratorKind::exact;
    const auto second = std::make_shared<const SceneDescription>(scene);
    const FrameTiming timing{60.0, 16};
    const std::vector<ClipScene> one{{first, "", timing}}, both{{first, "a", timing}, {second, "b", timing}};
    EXPECT_EQ(make_composition(one, {}).text.mode, "symplectic-euler, impacts stepped, h = 1/960 s, seed 1");
    EXPECT_EQ(make_composition(both, {}).text.mode, "impacts stepped, h = 1/960 s, seed 1");
}

// Insets and logo.

std::shared_ptr<const SceneDescription> scene_with_insets() {
    auto scene = std::make_shared<SceneDescription>();
    scene->output.width = 320;
    scene->output.height = 180;
    CameraInset corner;
    corner.end = 1.0;
    corner.border = 4.0;
    CameraInset rectangle;
    rectangle.rectangle = {0.0, 0.5, 0.25, 0.5};
    rectangle.start = 0.5;
    rectangle.end = 2.0;
    scene->camera.insets = {corner, rectangle};
    return scene;
}

TEST(Insets, LieInTheirCornerOrRectangle) {
    const std::vector<ClipScene> scenes{{scene_with_insets(), "", {}}};
    const Composition composition = make_composition(scenes, {});
    ASSERT_EQ(composition.insets.size(), 2u);
    EXPECT_EQ(composition.insets[0].place, (Rectangle{320 - 5 - 96, 5, 96, 54}));
    EXPECT_EQ(composition.insets[0].border, 1);
    EXPECT_EQ(composition.insets[1].place, (Rectangle{0, 90, 80, 90}));
    EXPECT_EQ(composition.insets[1].scene->output.width, 80);
    EXPECT_TRUE(composition.insets[1].scene->camera.insets.empty());
    EXPECT_FALSE(composition.plain());
    EXPECT_TRUE(composition.changes(0.4, 0.6));
    EXPECT_FALSE(composition.changes(0.6, 0.7));
}

Image filled(int width, int height, std::uint8_t value) {
    Image image(width, height);
    for (int y = 0; y < height; ++y) std::fill_n(image.at(0, y), 4 * width, value);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y)[3] = 255;
    return image;
}

// A composer that draws each frame from the one before has the pixels of a new one.
TEST(Insets, PartialCompositionEqualsAFullOne) {
    const std::vector<ClipScene> scenes{{scene_with_insets(), "", {}}};
    const Composition composition = make_composition(scenes, {});
    FrameComposer partial(composition, false);
    const std::vector<Rectangle> whole{{0, 0, 320, 180}}, none, part{{30, 10, 40, 30}};
    for (int n = 0; n < 25; ++n) {
        const double time = 0.1 * n;
        Image panel = filled(320, 180, 40), corner = filled(96, 54, 120), rectangle = filled(80, 90, 200);
        for (int y = 10; y < 40; ++y) std::fill_n(corner.at(30, y), 4 * 40, std::uint8_t(100 + n));
        for (int y = 10; y < 40; ++y) std::fill_n(panel.at(30, y), 4 * 40, std::uint8_t(n));
        const auto compose = [&](FrameComposer& composer, const std::vector<Rectangle>& changed) {
            const std::vector<PanelImage> panels{{panel, changed}};
            std::vector<std::optional<PanelImage>> insets;
            if (composition.insets[0].shown(time))
                insets.emplace_back(PanelImage{corner, changed});
            else
                insets.emplace_back();
            if (composition.insets[1].shown(time))
                insets.emplace_back(PanelImage{rectangle, none});
            else
                insets.emplace_back();
            composer.compose(panels, insets, time);
        };
        compose(partial, part);
        FrameComposer full(composition, false);
        compose(full, whole);
        for (int y = 0; y < 180; ++y)
            ASSERT_TRUE(std::equal(full.image().at(0, y), full.image().at(0, y) + 4 * 320, partial.image().at(0, y)))
                << n << ' ' << y;
        const int inset = partial.image().at(250, 30)[0];
        EXPECT_EQ(inset >= 100, composition.insets[0].shown(time)) << n;
    }
}

TEST(Logo, KeepsItsFormAndItsLight) {
    auto texture = std::make_shared<Texture>();
    Texture::Level& level = texture->levels.emplace_back();
    level.width = 4;
    level.height = 2;
    level.texels.assign(8, {255, 255, 255, 255});
    for (std::size_t i = 0; i < 8; i += 2) level.texels[i] = {0, 0, 0, 255};
    auto scene = std::make_shared<SceneDescription>();
    scene->output.width = 320;
    scene->output.height = 180;
    scene->overlay.logo = LogoDescription{texture, FrameCorner::bottom_left, 0.1, 0.05, 0.5};
    const std::vector<ClipScene> scenes{{scene, "", {}}};
    const Composition composition = make_composition(scenes, {});
    ASSERT_TRUE(composition.logo);
    EXPECT_EQ(composition.logo->place, (Rectangle{9, 180 - 9 - 16, 32, 16}));
    const Image half = scaled_image(level, 2, 1, 0.5);
    for (int x = 0; x < 2; ++x) {
        EXPECT_EQ(half.at(x, 0)[0], 188);  // half of the light, not of the bytes
        EXPECT_EQ(half.at(x, 0)[3], 128);
    }
    EXPECT_EQ(scaled_image(level, 4, 2, 1.0).at(1, 1)[0], 255);
}

}  // namespace
}  // namespace tumble::composition_test
