// tolerances.toml: values by pattern, masks, and the place of every mistake.
#include "compare/tolerances.h"
#include "core/error.h"
#include "output/png_writer.h"

#include "support/folder.h"
#include "support/pictures.h"

#include <gtest/gtest.h>

namespace tumble::tolerances_test {
namespace {

class TolerancesFile : public testing::Test {
protected:
    Tolerances read(const std::string& text, const PairTolerances& base = {}) {
        write_text(folder_ / "tolerances.toml", text);
        return Tolerances::read(folder_ / "tolerances.toml", base);
    }

    /// The message without the folder.
    std::string mistake(const std::string& text) {
        try {
            read(text);
        } catch (const InputError& error) {
            std::string what = error.what();
            for (std::size_t at = 0; (at = what.find(folder_.path().string() + "/")) != std::string::npos;)
                what.erase(at, folder_.path().string().size() + 1);
            return what;
        }
        return "";
    }

    TestFolder folder_;
};

TEST_F(TolerancesFile, LaterRulesRefineEarlierOnesKeyByKey) {
    const Tolerances tolerances = read(R"(
levels = 5
[[rule]]
files = "smoke/*.png"
levels = 8
fraction = 0.01
[[rule]]
files = ["smoke/b*.png", "*.PNG"]
levels = 9
ssim = 0.9
)");
    EXPECT_EQ(tolerances.of("a.png").pixels.tolerance, 5);
    EXPECT_EQ(tolerances.of("a.png").rule, "");
    EXPECT_EQ(tolerances.of("smoke/a.png").pixels.tolerance, 8);
    EXPECT_EQ(tolerances.of("smoke/a.png").rule, "smoke/*.png");
    const PairTolerances both = tolerances.of("smoke/b1.png");
    EXPECT_EQ(both.pixels.tolerance, 9);
    EXPECT_EQ(both.pixels.fraction, 0.01);
    EXPECT_EQ(both.ssim, 0.9);
    EXPECT_EQ(both.rule, "smoke/b*.png");
    EXPECT_EQ(tolerances.of("x.PNG").rule, "*.PNG");
}

TEST_F(TolerancesFile, KeysThatAreAbsentHaveTheValuesOfTheCommandLine) {
    PairTolerances base;
    base.pixels.tolerance = 7;
    base.pixels.window = 2.0;
    const Tolerances tolerances = read("[[rule]]\nfiles = \"a.png\"\nwindow = 3\n", base);
    EXPECT_EQ(tolerances.of("a.png").pixels.tolerance, 7);
    EXPECT_EQ(tolerances.of("a.png").pixels.window, 3.0);
    EXPECT_EQ(tolerances.of("b.png").pixels.window, 2.0);
}

TEST_F(TolerancesFile, ExactLeavesNoTolerance) {
    const PairTolerances exact = read("exact = true\n").of("a.png");
    EXPECT_EQ(exact.pixels.tolerance, 0);
    EXPECT_EQ(exact.pixels.fraction, 0.0);
    const Image a = landscape(64, 48);
    Image b = a;
    EXPECT_TRUE(compare_images(a, b, exact.pixels).alike);
    b.at(30, 20)[1] ^= 1;
    EXPECT_FALSE(compare_images(a, b, exact.pixels).alike);
}

TEST_F(TolerancesFile, Masks) {
    Image clock = plain(20, 10, {0, 0, 0});
    set(clock, 3, 4, {255, 255, 255});
    write_png(folder_ / "clock.png", clock);
    const Tolerances tolerances = read(R"(
masks = [{ pixels = [1, 2, 3, 4] }, { fractions = [0.5, 0.0, 0.5, 0.1] }, { file = "clock.png" }]
[[rule]]
files = "plain.png"
masks = []
)");
    const IgnoredPixels ignored(tolerances.of("a.png").masks, 20, 10);
    EXPECT_EQ(ignored.count(), 12 + 10);  // the pixel of the picture is in the first rectangle
    EXPECT_TRUE(ignored.at(3, 5) && ignored.at(1, 2) && ignored.at(10, 0) && ignored.at(19, 0));
    EXPECT_FALSE(ignored.at(4, 2) || ignored.at(3, 6) || ignored.at(9, 0) || ignored.at(10, 1));
    EXPECT_TRUE(tolerances.of("plain.png").masks.empty());
    EXPECT_THROW(IgnoredPixels(tolerances.of("a.png").masks, 21, 10), InputError);
    EXPECT_THROW(IgnoredPixels(read("masks = [{ pixels = [18, 0, 3, 1] }]").of("a").masks, 20, 10), InputError);
}

TEST_F(TolerancesFile, RulesWithoutPictures) {
    const Tolerances tolerances = read("[[rule]]\nfiles = \"a*.png\"\n[[rule]]\nfiles = [\"b.png\", \"c.png\"]\n");
    const std::vector<std::string> unused = tolerances.unused({"a1.png", "d.png"});
    ASSERT_EQ(unused.size(), 1u);
    EXPECT_NE(unused[0].find("tolerances.toml:3: \"b.png\""), std::string::npos) << unused[0];
}

TEST_F(TolerancesFile, EveryMistakeHasItsPlace) {
    write_png(folder_ / "black.png", plain(4, 4, {0, 0, 0}));
    write_text(folder_ / "text.png", "no picture");
    const std::pair<const char*, const char*> mistakes[] = {
        {"levels = 256", "tolerances.toml:1:10: error: levels must be from 0 to 255 (given 256)"},
        {"levels = 2.5", "tolerances.toml:1:10: error: levels must be a whole number (given 2.5)"},
        {"fraction = nan", "tolerances.toml:1:12: error: fraction must be"},
        {"[[rule]]\nlevels = 2", "tolerances.toml:1:1: error: [[rule]] needs \"files\" (not given)"},
        {"[[rule]]\nfiles = 3", "tolerances.toml:2:9: error: files must be an array (given 3)"},
        {"[[rule]]\nfiles = []", "tolerances.toml:2:9: error: files must have a pattern of files (given [])"},
        {"[[rule]]\nfiles = [\"a\",\n  \"b[\"]",
         "tolerances.toml:3:3: error: files is no pattern of files: it has a '[' without ']' (given \"b[\")"},
        {"[[rule]]\nfiles = \"a\"\nlevel = 2", "tolerances.toml:3:1: error: unknown key \"level\" in [[rule]]"},
        {"rules = []", "tolerances.toml:1:1: error: unknown key \"rules\" in a file of tolerances"},
        {"masks = [{}]", "tolerances.toml:1:10: error: a mask needs one of"},
        {"masks = [{ pixels = [0, 0, 1, 1], file = \"a.png\" }]", "tolerances.toml:1:10: error: a mask needs one of"},
        {"masks = [{ pixels = [0, 0, 0, 1] }]", "tolerances.toml:1:28: error: pixels must be"},
        {"masks = [{ pixels = [0, 0, 1] }]",
         "tolerances.toml:1:21: error: pixels must be an array of 4 whole numbers: x, y, width, height (given [0, 0, "
         "1])"},
        {"masks = [{ fractions = [0.5, 0, 0.6, 1] }]",
         "tolerances.toml:1:24: error: fractions must lie within the picture"},
        {"masks = [{ file = \"none.png\" }]", "tolerances.toml:1:19: error: file cannot be used: none.png: "},
        {"masks = [{ file = \"text.png\" }]", "tolerances.toml:1:19: error: file cannot be used: text.png: "},
        {"masks = [{ file = \"black.png\" }]",
         "tolerances.toml:1:19: error: file cannot be used: black.png: the mask has no white pixels"},
        {"platforms = [\"a/b\"]", "tolerances.toml:1:14: error: platforms must be the name of a folder, without '/'"},
        {"levels = ", "tolerances.toml:1:"},
    };
    for (const auto& [text, message] : mistakes)
        EXPECT_EQ(mistake(text).substr(0, std::string(message).size()), message);
    EXPECT_THROW(Tolerances::read(folder_ / "none.toml"), InputError);
    EXPECT_THROW(Tolerances::read(folder_.path()), InputError);
}

}  // namespace
}  // namespace tumble::tolerances_test
