// The mark of a clip's frames: which values it depends on, and the manifest that keeps it.
#include "app/resume/frame_identity.h"
#include "output/temporary_file.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

namespace tumble::frame_identity_test {
namespace {

const std::string base = "format = 1\ntitle = \"A\"\n[[body]]\nshape = { type = \"sphere\", radius = 0.5 }\n";

ClipScene scene_of(const std::string& text, const std::string& label = "") {
    const auto scene = std::make_shared<const SceneDescription>(parse_scene(text, "a.toml"));
    return {scene, label, scene->timing()};
}

FrameIdentity identity(const std::vector<ClipScene>& scenes, const NamedValues& settings = {{"size", "8x8"}}) {
    FrameIdentity made = identity_of(scenes, settings);
    made.frames = 301;
    made.fps = 29.97;
    return made;
}

std::string mark_of(const std::string& text) { return identity({scene_of(text)}).mark(); }

TEST(FrameIdentity, TheMarkDependsOnThePixelsOnly) {
    const std::string mark = mark_of(base);
    EXPECT_EQ(mark.size(), 64u);
    EXPECT_EQ(mark_of("# a comment\n" + base), mark);
    const std::string camera = "[camera]\neye = [0, 1, 9]\ntarget = [0, 0, 0]\n";
    EXPECT_EQ(mark_of(base + camera + "[simulation]\nduration = 9\n"), mark_of(base + camera));
    EXPECT_NE(mark_of(base + "[simulation]\nduration = 9\n"), mark);  // the default camera shows the whole motion
    EXPECT_NE(mark_of(base + "[simulation]\nseed = 9\n"), mark);
    EXPECT_NE(mark_of(base + "[simulation]\nsteps_per_frame = 9\n"), mark);
    EXPECT_NE(mark_of(base + "[output]\nfps = 30\n"), mark);
    EXPECT_NE(mark_of(base + "[output]\nsamples = 1\n"), mark);
    EXPECT_NE(mark_of(base + "[overlay]\nlegend = false\n"), mark);
    EXPECT_NE(identity({scene_of(base)}, {{"size", "8x9"}}).mark(), mark);
    EXPECT_NE(identity({scene_of(base)}, {}).mark(), mark);
    EXPECT_NE(identity({scene_of(base, "label")}).mark(), mark);
    EXPECT_NE(identity({scene_of(base), scene_of(base)}).mark(), mark);
    FrameIdentity other = identity({scene_of(base)});
    other.frames = 5;
    other.fps = 5.0;
    EXPECT_EQ(other.mark(), mark);
    other.version += "x";
    EXPECT_NE(other.mark(), mark);
}

// The title counts where it is shown, and the duration where something is laid out for the whole clip.
TEST(FrameIdentity, TitleAndDurationCountWithOverlays) {
    const std::string longer = "[simulation]\nduration = 9\n";
    EXPECT_EQ(mark_of(base), mark_of("format = 1\ntitle = \"B\"\n" + base.substr(base.find("[[body"))));
    for (const char* const overlay : {"show = [\"clock\"]\n", "plot = [\"energy\"]\n"}) {
        const std::string shown = base + "[overlay]\n" + overlay;
        EXPECT_NE(mark_of(shown), mark_of(shown + longer)) << overlay;
    }
    const std::string caption = base + "[[caption]]\ntext = \"a\"\n";
    EXPECT_NE(mark_of(caption), mark_of(caption + longer));
    EXPECT_NE(identity({scene_of(base), scene_of(base)}).mark(),
              identity({scene_of(base + longer), scene_of(base)}).mark());
    const std::string titled = "[overlay]\nshow = [\"title\"]\n";
    EXPECT_NE(mark_of(base + titled),
              mark_of("format = 1\ntitle = \"B\"\n" + base.substr(base.find("[[body")) + titled));
}

TEST(FrameIdentity, AManifestKeepsIt) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "tumble-frame-identity-test.json";
    const FrameIdentity written = identity({scene_of(base, "a = 1"), scene_of(base + "[light]\nshadows = false\n")});
    const std::string text = manifest_text(written);
    write_file(path, text);
    const std::optional<FrameIdentity> read = read_manifest(path);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->mark(), written.mark());
    EXPECT_EQ(read->scenes, written.scenes);
    EXPECT_EQ(read->settings, written.settings);
    EXPECT_EQ(read->frames, 301);
    EXPECT_EQ(read->fps, 29.97);
    EXPECT_EQ(manifest_text(*read), text);
    for (std::size_t n = 0; n < text.size(); n += 97) {  // cut anywhere
        write_file(path, std::string_view(text).substr(0, n));
        EXPECT_FALSE(read_manifest(path)) << n;
    }
    std::filesystem::remove(path);
    EXPECT_FALSE(read_manifest(path));
}

TEST(FrameIdentity, DifferencesAreNamed) {
    const FrameIdentity one = identity({scene_of(base)});
    FrameIdentity other = identity({scene_of(base + "[output]\nsamples = 1\n[light]\nshadows = false\n")},
                                   {{"size", "16x8"}, {"blur samples", "4"}});
    EXPECT_EQ(differences(one, other),
              "the light of a.toml, the samples of a.toml (4 there, 1 here), size (8x8 there, 16x8 here), blur samples "
              "(none there, 4 here)");
    other = one;
    other.version = "9.9";
    EXPECT_EQ(differences(other, one), "the version of the program (9.9 there, " + one.version + " here)");
    EXPECT_EQ(differences(one, identity({scene_of(base, "b")})), "the label of panel 1");
    EXPECT_EQ(differences(identity({scene_of(base), scene_of(base)}), one).substr(0, 44),
              "the number of scenes (2 there, 1 here)" + std::string());
}

}  // namespace
}  // namespace tumble::frame_identity_test
