// Accepting by a drawer whose images depend on the number of processes, fail, or end their process.
#include "app/golden/accept.h"
#include "app/golden/check.h"
#include "core/error.h"
#include "core/image.h"
#include "output/png_reader.h"
#include "output/png_writer.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tumble::golden_accept_test {
namespace {

/// Gray images. A case of the name "unsteady" has a pixel that depends on the number of processes in frame 1, "broken"
/// cannot be drawn, and "crash" ends its process.
class GrayDrawer : public CaseDrawer {
public:
    int level = 100;

    std::string identity(const GoldenCase&) const override { return std::to_string(level); }
    void draw(const GoldenCase& golden, const std::filesystem::path& folder, const DrawingWork& work) const override {
        if (golden.name == "broken") throw InputError("it is broken");
        if (golden.name == "crash") ::_exit(3);
        for (const std::int64_t frame : golden.frames) {
            Image image(32, 24);
            std::ranges::fill(image.pixels, std::uint8_t(level));
            if (golden.name == "unsteady" && frame == 1) *image.at(5, 6) = std::uint8_t(level + work.workers);
            write_png(folder / golden.image_name(frame), image);
        }
        write_text(folder / golden.record_name(), "{}");
    }
};

GoldenSuite suite_in(const TestFolder& folder) {
    std::string text = "format = 1\n[defaults]\nframes = [0, 1]\n";
    for (const char* name : {"steady", "unsteady", "broken", "crash"})
        text += std::string("[[case]]\nscene = \"s.toml\"\nname = \"") + name + "\"\n";
    return parse_suite(text, folder / "golden.toml");
}

std::vector<AcceptedImage> accept_all(const GoldenSuite& suite, const GrayDrawer& drawer) {
    std::vector<const GoldenCase*> cases;
    for (const GoldenCase& golden : suite.cases) cases.push_back(&golden);
    Interrupt interrupt;
    return accept_cases(suite, cases, drawer, {std::nullopt, false, 2}, interrupt);
}

TEST(GoldenAccept, RefusesACaseThatDoesNotRenderTwiceAlike) {
    const TestFolder folder;
    const GoldenSuite suite = suite_in(folder);
    const std::vector<AcceptedImage> images = accept_all(suite, {});
    using What = AcceptedImage::What;
    const std::vector<What> expected{What::made,   What::made,   What::refused, What::refused,
                                     What::broken, What::broken, What::broken,  What::broken};
    ASSERT_EQ(images.size(), expected.size());
    for (std::size_t i = 0; i < images.size(); ++i) EXPECT_EQ(images[i].what, expected[i]) << images[i].name;
    EXPECT_EQ(images[2].reason, "another image of its case does not render twice alike");
    EXPECT_EQ(
        images[3].reason,
        "does not render twice alike: 1 pixels differ, by 2 levels at most, between drawings with 1 and 3 processes");
    EXPECT_NE(images[4].reason.find("it is broken"), std::string::npos) << images[4].reason;
    EXPECT_NE(images[6].reason.find("exit code 3"), std::string::npos) << images[6].reason;
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(suite.references))
        files.push_back(entry.path().filename());
    std::ranges::sort(files);
    EXPECT_EQ(files, (std::vector<std::string>{"steady.motion.json", "steady_000000.png", "steady_000001.png"}));
}

TEST(GoldenAccept, RefusedImagesLeaveTheReferences) {
    const TestFolder folder;
    GoldenSuite suite = suite_in(folder);
    accept_all(suite, {});
    std::filesystem::rename(suite.references / "steady_000000.png", suite.references / "unsteady_000000.png");
    const std::string before = read_text(suite.references / "unsteady_000000.png");
    GrayDrawer darker;
    darker.level = 30;
    accept_all(suite, darker);
    EXPECT_EQ(read_text(suite.references / "unsteady_000000.png"), before);
    EXPECT_EQ(read_png(suite.references / "steady_000001.png").pixels[0], 30);
}

TEST(GoldenCheck, AFailureOfOneCaseIsThatCaseAlone) {
    const TestFolder folder;
    const GoldenSuite suite = suite_in(folder);
    const GrayDrawer drawer;
    accept_all(suite, drawer);
    std::vector<const GoldenCase*> cases;
    for (const GoldenCase& golden : suite.cases) cases.push_back(&golden);
    Interrupt interrupt;
    const ImageCache cache(folder / "cache");
    DrawCasesOptions options;
    options.jobs = 3;
    const std::vector<DrawnCase> drawn = draw_cases(cases, drawer, cache, options, interrupt);
    const SetResult result = check_cases(suite, drawn, {}, interrupt);
    std::vector<Verdict> verdicts;
    for (const ImageResult& image : result.images) verdicts.push_back(image.verdict);
    EXPECT_EQ(verdicts, (std::vector<Verdict>{Verdict::same, Verdict::same, Verdict::missing, Verdict::missing,
                                              Verdict::broken, Verdict::broken, Verdict::broken, Verdict::broken}));
    EXPECT_EQ(result.exit_code(), 2);
    // No part of a drawing is left.
    for (const auto& entry : std::filesystem::directory_iterator(folder / "cache"))
        EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
    // Again: nothing is drawn but the cases that failed.
    const std::vector<DrawnCase> again = draw_cases(cases, drawer, cache, options, interrupt);
    EXPECT_FALSE(again[0].drawn || again[1].drawn);
    EXPECT_EQ(again[0].folder, drawn[0].folder);
}

}  // namespace
}  // namespace tumble::golden_accept_test
