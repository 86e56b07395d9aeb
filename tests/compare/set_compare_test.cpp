// Pairs of pictures and sets of them: verdicts, masks, order, failures.
#include "compare/image_folder.h"
#include "compare/pair_compare.h"
#include "compare/platform.h"
#include "core/error.h"
#include "output/png_writer.h"

#include "support/folder.h"
#include "support/pictures.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>

namespace tumble::set_compare_test {
namespace {

namespace fs = std::filesystem;

class Sets : public testing::Test {
protected:
    fs::path write(const std::string& name, const Image& image) {
        const fs::path file = folder_ / name;
        fs::create_directories(file.parent_path());
        write_png(file, image);
        return file;
    }

    std::vector<ImageResult> compare(const Tolerances& tolerances = Tolerances(), int workers = 2) {
        const std::vector<ImagePair> pairs =
            pairs_of(pictures_in(folder_ / "a").files, pictures_in(folder_ / "b").files);
        std::size_t i = 0;
        return compare_pairs([&] { return i < pairs.size() ? std::optional(pairs[i++]) : std::nullopt; }, tolerances,
                             workers);
    }

    TestFolder folder_;
};

Image with_box(int x, Pixel color = {200, 30, 30}) {
    Image image = landscape(96, 64);
    fill(image, x, 30, 9, 9, color);
    return image;
}

TEST_F(Sets, EachVerdict) {
    Image noisy = with_box(20);
    set(noisy, 50, 50, {255, 255, 255});
    noisy.at(50, 50)[0] = std::uint8_t(with_box(20).at(50, 50)[0] + 20);
    for (const char* name :
         {"a/alike.png", "a/different.png", "a/missing.png", "a/same.png", "a/size.png", "a/text.png"})
        write(name, with_box(20));
    Image near = with_box(20);
    near.at(50, 50)[0] ^= 1;
    write("b/alike.png", near);
    write("b/different.png", with_box(21));
    write("b/deep/er/added.png", with_box(20));
    write("b/same.png", with_box(20));
    write("b/size.png", landscape(95, 64));
    write_text(folder_ / "b/text.png", "no picture");
    const std::vector<ImageResult> results = compare();
    std::string verdicts;
    for (const ImageResult& result : results) verdicts += fmt::format("{} {}\n", result.name, name_of(result.verdict));
    EXPECT_EQ(verdicts,
              "alike.png alike\ndeep/er/added.png added\ndifferent.png different\nmissing.png missing\nsame.png same\n"
              "size.png broken\ntext.png broken\n");
    const ImageResult& different = results[2];
    EXPECT_EQ(different.changed, (Rectangle{20, 30, 10, 9}));
    EXPECT_EQ(different.differing_pixels, 18);
    ASSERT_EQ(different.figures.size(), 4u);
    EXPECT_EQ(different.figures[1].metric, "cluster");
    EXPECT_FALSE(different.figures[1].holds);
    EXPECT_NE(different.reason.find("key cluster"), std::string::npos) << different.reason;
    EXPECT_NE(results[5].reason.find("95 x 64"), std::string::npos) << results[5].reason;
    EXPECT_EQ(results[0].changed, (Rectangle{50, 50, 1, 1}));
}

TEST_F(Sets, ABrokenFileIsNotTheSameAsItself) {
    write("a/x.png", landscape(64, 64));
    fs::resize_file(folder_ / "a/x.png", fs::file_size(folder_ / "a/x.png") - 40);
    fs::create_directories(folder_ / "b");
    fs::copy_file(folder_ / "a/x.png", folder_ / "b/x.png");
    EXPECT_EQ(compare().front().verdict, Verdict::broken);
    fs::remove(folder_ / "b/x.png");
    write_text(folder_ / "a/x.png", "no picture");
    EXPECT_EQ(compare().front().verdict, Verdict::broken);  // and not only missing
}

TEST_F(Sets, MaskedPixelsDoNotCount) {
    write("a/x.png", with_box(20));
    write("b/x.png", with_box(40));
    PairTolerances masked;
    masked.masks = {{Rectangle{20, 30, 9, 9}}, {Rectangle{40, 30, 9, 9}}};
    EXPECT_EQ(compare(Tolerances(masked)).front().verdict, Verdict::same);
    masked.masks.pop_back();
    EXPECT_EQ(compare(Tolerances(masked)).front().changed, (Rectangle{40, 30, 9, 9}));
    masked.masks = {{Rectangle{90, 30, 9, 9}}};
    const ImageResult outside = compare(Tolerances(masked)).front();
    EXPECT_EQ(outside.verdict, Verdict::broken);
    EXPECT_NE(outside.reason.find("mask"), std::string::npos) << outside.reason;
}

TEST_F(Sets, ResultsAreTheSameForAnyNumberOfWorkers) {
    for (int i = 0; i < 40; ++i) {
        if (i % 7 != 3) write(fmt::format("a/{}.png", i), with_box(20));
        if (i % 5 != 2) write(fmt::format("b/{}.png", i), with_box(20 + i % 3));
    }
    const std::vector<ImageResult> one = compare(Tolerances(), 1), many = compare(Tolerances(), 7);
    ASSERT_EQ(one.size(), many.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].name, many[i].name);
        EXPECT_EQ(one[i].verdict, many[i].verdict);
        EXPECT_EQ(one[i].reason, many[i].reason);
    }
    EXPECT_TRUE(std::is_sorted(many.begin(), many.end(), [](auto& a, auto& b) { return a.name < b.name; }));
}

TEST_F(Sets, AnErrorOfTheSourceEndsTheComparison) {
    int calls = 0;
    const PairSource source = [&]() -> std::optional<ImagePair> {
        if (++calls == 3) throw RunError("interrupted");
        const auto image = std::make_shared<const Image>(landscape(32, 32));
        return ImagePair{"x", ComparedPicture{{}, image}, ComparedPicture{{}, image}};
    };
    EXPECT_THROW(compare_pairs(source, Tolerances(), 4), RunError);
    EXPECT_EQ(calls, 3);
}

TEST_F(Sets, LinksAndHiddenFiles) {
    write("a/x.png", landscape(32, 32));
    write("a/.hidden/y.png", landscape(32, 32));
    write("a/.z.png", landscape(32, 32));
    write_text(folder_ / "a/notes.txt", "");
    fs::create_symlink("x.png", folder_ / "a/link.png");
    fs::create_symlink("none.png", folder_ / "a/dangling.png");
    fs::create_symlink(".", folder_ / "a/loop");
    const NamedFiles files = pictures_in(folder_ / "a").files;
    EXPECT_EQ(files.size(), 3u);
    EXPECT_TRUE(files.contains("x.png") && files.contains("link.png") && files.contains("dangling.png"));
    fs::create_directories(folder_ / "b");
    EXPECT_EQ(compare().front().verdict, Verdict::broken);  // the dangling one
    EXPECT_THROW(pictures_in(folder_ / "none"), InputError);
}

TEST(Platforms, TheirFilesReplaceGeneralOnes) {
    const NamedFiles files{{"a.png", "g/a.png"},
                           {"amd/a.png", "g/amd/a.png"},
                           {"amd/c.png", "g/amd/c.png"},
                           {"b.png", "g/b.png"},
                           {"ci/b.png", "g/ci/b.png"},
                           {"intel/b.png", "g/intel/b.png"},
                           {"other/x.png", "g/other/x.png"}};
    const References amd = references_of(files, {{"other/x.png", ""}}, "amd", {"amd", "intel", "other", "ci"});
    const NamedFiles expected{
        {"a.png", "g/amd/a.png"}, {"b.png", "g/b.png"}, {"c.png", "g/amd/c.png"}, {"other/x.png", "g/other/x.png"}};
    EXPECT_EQ(amd.files, expected);
    EXPECT_EQ(amd.platform, "amd");
    const References none = references_of(files, {}, "", {"amd", "intel", "other", "ci"});
    EXPECT_EQ(none.files, (NamedFiles{{"a.png", "g/a.png"}, {"b.png", "g/b.png"}}));
    EXPECT_EQ(none.platform, "");
    EXPECT_EQ(references_of(files, {}, "ci", {}).files.at("b.png"), "g/ci/b.png");
}

TEST(Platforms, NamesOfProcessors) {
    EXPECT_EQ(platform_of("processor : 0\nvendor_id\t: AuthenticAMD\n"), "amd");
    EXPECT_EQ(platform_of("vendor_id\t: GenuineIntel\n"), "intel");
    EXPECT_EQ(platform_of("CPU implementer\t: 0x41\n"), "arm");
    EXPECT_EQ(platform_of(""), "other");
}

TEST(SetResults, ExitCodes) {
    const auto code = [](std::initializer_list<Verdict> verdicts, bool added_allowed = false) {
        SetResult result;
        result.added_allowed = added_allowed;
        for (const Verdict verdict : verdicts) {
            result.images.emplace_back();
            result.images.back().verdict = verdict;
        }
        return result.exit_code();
    };
    EXPECT_EQ(code({Verdict::same, Verdict::alike}), 0);
    EXPECT_EQ(code({Verdict::same, Verdict::different}), 1);
    EXPECT_EQ(code({Verdict::added}), 1);
    EXPECT_EQ(code({Verdict::added}, true), 0);
    EXPECT_EQ(code({Verdict::missing, Verdict::different}), 3);
    EXPECT_EQ(code({Verdict::missing, Verdict::broken}), 2);
}

}  // namespace
}  // namespace tumble::set_compare_test
