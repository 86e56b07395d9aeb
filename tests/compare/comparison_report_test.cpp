// The report of a comparison: order, content, policy, size, and the same bytes with any number of workers.
#include "compare/report/comparison_report.h"
#include "compare/report/report_entry.h"
#include "compare/report/report_pictures.h"
#include "output/png_writer.h"

#include "support/folder.h"
#include "support/pictures.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <sys/stat.h>

#include <fstream>
#include <sstream>
#include <string>

namespace tumble::comparison_report_test {
namespace {

namespace fs = std::filesystem;

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

class Report : public testing::Test {
protected:
    /// A pair with a box that moves by so many pixels.
    ImageResult pair(const std::string& name, int moved, Verdict verdict = Verdict::different) {
        ImageResult result;
        result.name = name;
        result.reference = write("a_" + name, 10);
        result.image = write("b_" + name, 10 + moved);
        result.verdict = verdict;
        result.width = 96;
        result.height = 64;
        result.differing_pixels = 18 * moved;
        result.max_difference = 100;
        result.changed = {10, 20, 9 + moved, 9};
        const double value = moved, limit = 1.5;
        result.figures = {{"pixels", value, limit, value <= limit, 11, 21}};
        if (value > limit) result.reason = "rule pixels: too many";
        return result;
    }

    fs::path write(const std::string& name, int x) {
        Image image = landscape(96, 64);
        fill(image, x, 20, 9, 9, {200, 30, 30});
        write_png(folder_ / name, image);
        return folder_ / name;
    }

    std::string html(const SetResult& set, std::int64_t most_bytes = std::int64_t(1) << 30, int workers = 2) {
        ReportOptions options;
        options.most_picture_bytes = most_bytes;
        options.workers = workers;
        options.generator = "Tumble 1.2.3";
        const fs::path file = folder_ / "report.html";
        write_comparison_report(set, options, file);
        std::ifstream stream(file, std::ios::binary);
        std::ostringstream text;
        text << stream.rdbuf();
        return text.str();
    }

    TestFolder folder_;
};

TEST_F(Report, TheWorstComesFirst) {
    SetResult set;
    set.images = {pair("alike.png", 1, Verdict::alike), pair("little.png", 2), pair("much.png", 9),
                  pair("same.png", 0, Verdict::same)};
    for (const Verdict verdict : {Verdict::added, Verdict::missing, Verdict::broken}) {
        set.images.emplace_back();
        set.images.back().name = std::string(name_of(verdict));
        set.images.back().verdict = verdict;
    }
    std::string names;
    for (const ImageResult* image : by_severity(set)) names += image->name + " ";
    EXPECT_EQ(names, "broken missing much.png little.png added alike.png ");
}

TEST_F(Report, AnExcessIsInUnitsOfTheLimit) {
    EXPECT_EQ(excess({"pixels", 12.0, 4.0, false}), 3.0);
    EXPECT_EQ(excess({"pixels", 0.0, 0.0, true}), 0.0);
    EXPECT_EQ(excess({"pixels", 1.0, 0.0, false}), 1e6);
    EXPECT_NEAR(excess({"ssim", 0.90, 0.95, false}), 2.0, 1e-12);  // lower is worse
    EXPECT_LT(excess({"ssim", 0.99, 0.95, true}), 1.0);
}

TEST_F(Report, PicturesAreThoseOfTheFiles) {
    SetResult set;
    set.images = {pair("moved.png", 5)};
    const std::string page = html(set);
    EXPECT_EQ(count(page, "<figure data-role=\"reference\""), 1u);
    EXPECT_EQ(count(page, "<figure data-role=\"image\""), 1u);
    EXPECT_EQ(count(page, "<figure data-role=\"flip\""), 1u);
    EXPECT_EQ(count(page, "<figure data-role=\"windows\""), 1u);
    EXPECT_EQ(count(page, "data:image/png;base64,iVBOR"), 5u);  // and a thumbnail
    EXPECT_NE(page.find("data-changed=\"10 20 14 9\""), std::string::npos);
    EXPECT_NE(page.find("1 of 1 picture fails"), std::string::npos);
    EXPECT_NE(page.find("Tumble 1.2.3"), std::string::npos);
}

TEST_F(Report, EqualPicturesAreNamedOnly) {
    SetResult set;
    set.images = {pair("one.png", 0, Verdict::same), pair("two.png", 0, Verdict::same)};
    const std::string page = html(set);
    EXPECT_EQ(count(page, "data:image/png"), 0u);
    EXPECT_NE(page.find("All 2 pictures are the same"), std::string::npos);
    EXPECT_EQ(count(page, "<li>one.png</li>"), 1u);
}

TEST_F(Report, ForeignTextIsText) {
    SetResult set;
    set.images = {pair("moved.png", 5)};
    set.images[0].name = "<script>alert(1)</script>\".png";
    set.images[0].causes = {"body \"<b>\" & more moved by 3 px"};
    set.images[0].reason = "<i>one</i>\n<i>two</i>";
    set.images[0].rule = "<u>*";
    set.reference = "<s>a";
    set.image = "</title><s>b";
    const std::string page = html(set);
    for (const char* tag : {"<script>alert", "<b>", "<i>", "<u>", "<s>", "</title><"})
        EXPECT_EQ(page.find(tag), std::string::npos) << tag;
    EXPECT_NE(page.find("<li>body &quot;&lt;b&gt;&quot; &amp; more moved by 3 px</li>"), std::string::npos);
    EXPECT_EQ(count(page, "&lt;i&gt;"), 2u);
}

TEST_F(Report, ThePolicyNamesTheScriptAndTheStyle) {
    SetResult set;
    set.images = {pair("moved.png", 5)};
    const std::string page = html(set);
    EXPECT_EQ(count(page, "default-src 'none'; script-src 'sha256-"), 1u);
    EXPECT_EQ(count(page, "unsafe"), 0u);
    EXPECT_EQ(count(page, " style=\""), 0u);
    EXPECT_EQ(count(page, "http://") + count(page, "https://"), count(page, "http://www.w3.org/2000/svg"));
}

TEST_F(Report, BrokenAndMissingPicturesAreLeftOut) {
    SetResult set;
    set.images = {pair("broken.png", 5, Verdict::broken), pair("missing.png", 5, Verdict::missing)};
    std::ofstream(set.images[0].image) << "no picture";
    set.images[1].image.clear();
    fs::remove(set.images[1].reference);
    ASSERT_EQ(mkfifo(set.images[1].reference.c_str(), 0600), 0);  // nobody writes to it
    const std::string page = html(set);
    EXPECT_EQ(count(page, "<figure"), 1u);
    EXPECT_EQ(count(page, "data:image/png"), 2u);  // the reference of the first, and its thumbnail
}

TEST_F(Report, ThePicturesOfTheLeastDifferencesAreLeftOutFirst) {
    SetResult set;
    for (int i = 2; i < 30; ++i) set.images.push_back(pair(fmt::format("image_{:02}.png", i), i));
    const std::string whole = html(set);
    EXPECT_EQ(count(whole, "<figure"), 4u * 28u);
    std::uintmax_t files = 0;
    for (const ImageResult& image : set.images) files += fs::file_size(image.reference) + fs::file_size(image.image);
    const std::string part = html(set, std::int64_t(files / 2));
    const std::size_t figures = count(part, "<figure");
    EXPECT_GT(figures, 4u);
    EXPECT_LT(figures, 4u * 20u);
    EXPECT_NE(part.find("Reference of image_29.png"), std::string::npos);
    EXPECT_EQ(part.find("Reference of image_02.png"), std::string::npos);
    EXPECT_NE(part.find(fmt::format("those of {} pairs are left out", 28 - figures / 4)), std::string::npos);
    EXPECT_EQ(count(part, "<article"), 28u);  // each keeps its figures
    EXPECT_LT(part.size(), whole.size());
}

TEST_F(Report, PicturesOfTheListCountForTheLimit) {
    SetResult set;
    for (int i = 2; i < 30; ++i) set.images.push_back(pair(fmt::format("image_{:02}.png", i), i));
    for (const std::int64_t limit : {0, 500, 5000, 20000}) {
        const std::string page = html(set, limit), data = ";base64,";
        std::size_t characters = 0;
        for (std::size_t at = page.find(data); at != std::string::npos; at = page.find(data, at + 1))
            characters += page.find('"', at) - at - data.size();
        EXPECT_LE(characters * 3 / 4, std::size_t(limit) + 2 * count(page, data)) << limit;  // padding
        EXPECT_EQ(count(page, "<article"), 28u);
    }
}

TEST_F(Report, PicturesOfTwoSizesHaveThatOfTheirDifference) {
    SetResult set;
    set.images = {pair("size.png", 5, Verdict::broken)};
    write_png(set.images[0].image, landscape(80, 70));
    set.images[0].image_width = 80;
    set.images[0].image_height = 70;
    const std::string page = html(set);
    EXPECT_EQ(count(page, "<figure data-role=\"difference\"><img src=\"data:image/png;base64,"), 1u);
    EXPECT_EQ(count(page, "width=\"96\" height=\"70\""), 1u);
    EXPECT_EQ(count(page, "<figure data-role=\"flip\""), 0u);
    EXPECT_EQ(count(page, "80 × 70 pixels, the reference 96 × 64"), 1u);
}

TEST_F(Report, TheBytesDoNotDependOnTheWorkers) {
    SetResult set;
    for (int i = 2; i < 24; ++i) set.images.push_back(pair(fmt::format("image_{:02}.png", i), i));
    const std::int64_t bytes = 40000;
    EXPECT_EQ(html(set, bytes, 1), html(set, bytes, 5));
}

TEST_F(Report, AThumbnailIsTheMeanOfItsPixels) {
    Image image = plain(400, 100, {0, 0, 0});
    fill(image, 200, 0, 200, 100, {200, 100, 50});
    const Image small = thumbnail(image, 192, 144);
    EXPECT_EQ(small.width, 192);
    EXPECT_EQ(small.height, 48);
    EXPECT_EQ(small.at(10, 10)[0], 0);
    EXPECT_EQ(small.at(180, 10)[0], 200);
    EXPECT_EQ(thumbnail(plain(20, 30, {9, 9, 9}), 192, 144), plain(20, 30, {9, 9, 9}));
    EXPECT_EQ(thumbnail(plain(9000, 2, {9, 9, 9}), 192, 144).height, 1);
}

}  // namespace
}  // namespace tumble::comparison_report_test
