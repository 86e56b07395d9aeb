// Written pictures are restored to the bit; broken files are refused by name; every kind of PNG can be read.
#include "core/error.h"
#include "output/png_reader.h"
#include "output/png_writer.h"

#include "support/folder.h"
#include "support/pictures.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <span>
#include <tuple>
#include <vector>

namespace tumble::png_test {
namespace {

std::vector<std::byte> encoded(const Image& image, PngAlpha alpha = PngAlpha::dropped) {
    PngEncoder encoder(alpha);
    const std::span<const std::byte> bytes = encoder.encode(image);
    return {bytes.begin(), bytes.end()};
}

std::string message_of(const std::filesystem::path& path) {
    try {
        read_png(path);
    } catch (const InputError& error) {
        return error.what();
    }
    return "read without an error";
}

TEST(Png, ComesBackToTheBit) {
    const TestFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 17}, {31, 1}, {33, 27}, {320, 180}, {641, 359}}) {
        const Image image = colorful(width, height);
        write_png(folder / "a.png", image);
        EXPECT_EQ(read_png(folder / "a.png"), image) << width << " x " << height;
        EXPECT_EQ(read_png_size(folder / "a.png"), (ImageSize{width, height}));
    }
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Png, LeavesAlphaOut) {
    const TestFolder folder;
    Image image = colorful(5, 4);
    image.at(2, 1)[3] = 7;
    write_png(folder / "a.png", image);
    EXPECT_EQ(read_png(folder / "a.png"), colorful(5, 4));
}

TEST(Png, KeepsAlpha) {
    const TestFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 1000}, {33, 27}, {500, 333}}) {
        Image image(width, height);
        std::uint32_t random = 1;
        for (std::uint8_t& byte : image.pixels)
            byte = static_cast<std::uint8_t>((random = 1664525 * random + 1013904223) >> 24);
        write_png(folder / "a.png", image, PngAlpha::kept);
        EXPECT_EQ(read_png(folder / "a.png"), image) << width << " x " << height;
        EXPECT_EQ(encoded(image, PngAlpha::kept)[25], std::byte{6}) << "color type: RGBA";
        EXPECT_LE(encoded(image, PngAlpha::kept).size(), png_bytes_bound(width, height, PngAlpha::kept));
    }
}

TEST(Png, SaysItIsSrgbRgb8) {
    const std::vector<std::byte> bytes = encoded(colorful(9, 5));
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_EQ(text.substr(1, 3), "PNG");
    EXPECT_EQ(text[24], 8);  // bits
    EXPECT_EQ(text[25], 2);  // RGB
    EXPECT_NE(text.find("sRGB"), std::string::npos);
}

TEST(Png, TheSamePictureIsTheSameBytes) {
    const std::vector<std::byte> first = encoded(colorful(64, 48));
    const std::vector<std::byte> second = encoded(colorful(64, 48));
    EXPECT_EQ(first, second);
}

void expect_parts_make_the_whole(PngAlpha alpha) {
    PngEncoder encoder(alpha);
    for (const auto& [width, height] : {std::pair{40, 100}, {7, 64}, {33, 31}}) {
        Image image = colorful(width, height);
        encoder.encode(image, {});  // of another size than the previous one: a full conversion, for any changed regions
        const std::vector<Rectangle> changes[] = {
            {{3, 0, 1, 1}}, {{0, height - 1, width, 1}}, {}, {{1, 5, 4, 20}, {5, 25, 2, 6}}, {{0, 0, width, height}}};
        int value = 0;
        for (const std::vector<Rectangle>& changed : changes) {
            for (const Rectangle& r : changed) fill(image, r.x, r.y, r.width, r.height, {++value, 9, 200});
            const std::span<const std::byte> part = encoder.encode(image, changed);
            EXPECT_TRUE(std::ranges::equal(part, encoded(image, alpha))) << width << " x " << height << ", " << value;
        }
    }
}

TEST(Png, ChangedPartsGiveTheBytesOfTheWhole) {
    for (const PngAlpha alpha : {PngAlpha::dropped, PngAlpha::kept}) expect_parts_make_the_whole(alpha);
}

TEST(Png, IncompressibleDataFits) {
    const TestFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 1000}, {500, 333}}) {
        Image image(width, height);
        std::uint32_t random = 1;
        for (std::uint8_t& byte : image.pixels)
            byte = static_cast<std::uint8_t>((random = 1664525 * random + 1013904223) >> 24);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) image.at(x, y)[3] = 255;
        write_png(folder / "a.png", image);
        EXPECT_EQ(read_png(folder / "a.png"), image);
        EXPECT_LE(encoded(image).size(), png_bytes_bound(width, height));
    }
}

TEST(Png, AnEmptyPictureIsRefused) {
    EXPECT_THROW(encoded(Image(0, 5)), RunError);
    const TestFolder folder;
    EXPECT_THROW(write_png(folder / "a.png", Image()), RunError);
    EXPECT_EQ(folder.files(), 0u);
}

TEST(Png, ReadsEveryKind) {
    const TestFolder folder;
    struct Kind {
        png_uint_32 format;
        std::vector<std::uint8_t> pixels;  // 2 x 1
        std::vector<std::uint8_t> expected;
    };
    const Kind kinds[] = {
        {PNG_FORMAT_GRAY, {10, 200}, {10, 10, 10, 255, 200, 200, 200, 255}},
        {PNG_FORMAT_GA, {10, 255, 200, 128}, {10, 10, 10, 255, 200, 200, 200, 128}},
        {PNG_FORMAT_RGB, {1, 2, 3, 4, 5, 6}, {1, 2, 3, 255, 4, 5, 6, 255}},
        {PNG_FORMAT_RGBA, {1, 2, 3, 255, 4, 5, 6, 77}, {1, 2, 3, 255, 4, 5, 6, 77}},
    };
    for (const Kind& kind : kinds) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        image.width = 2;
        image.height = 1;
        image.format = kind.format;
        ASSERT_NE(png_image_write_to_file(&image, (folder / "k.png").c_str(), 0, kind.pixels.data(), 0, nullptr), 0);
        EXPECT_EQ(read_png(folder / "k.png").pixels, kind.expected) << "format " << kind.format;
    }
    // A palette: the pixels are indices.
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 2;
    image.height = 1;
    image.format = PNG_FORMAT_RGB_COLORMAP;
    image.colormap_entries = 2;
    const std::uint8_t indices[] = {1, 0}, colors[] = {9, 8, 7, 30, 20, 10};
    ASSERT_NE(png_image_write_to_file(&image, (folder / "k.png").c_str(), 0, indices, 0, colors), 0);
    EXPECT_EQ(read_png(folder / "k.png").pixels, (std::vector<std::uint8_t>{30, 20, 10, 255, 9, 8, 7, 255}));
}

/// libpng's own simplified reader, as the reference.
std::vector<std::uint8_t> read_simply(const std::filesystem::path& path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
    image.format = PNG_FORMAT_RGBA;
    image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0) << image.message;
    return pixels;
}

/// A PNG of noise in any form; `gamma` 0: no gamma in the file.
void write_noise(const std::filesystem::path& path, int width, int height, int depth, int kind, bool interlaced,
                 bool transparent, double gamma) {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), depth, kind,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    std::uint32_t random = std::uint32_t(depth * 100 + kind);
    const auto next = [&] { return png_byte((random = 1664525 * random + 1013904223) >> 24); };
    std::vector<png_color> palette(std::size_t(1) << std::min(depth, 8));
    for (png_color& color : palette) color = {next(), next(), next()};
    const png_byte alphas[] = {0, 100};
    png_color_16 clear{};
    if (kind == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette.data(), int(palette.size()));
    if (transparent && kind == PNG_COLOR_TYPE_PALETTE)
        png_set_tRNS(png, info, alphas, 2, nullptr);
    else if (transparent)
        png_set_tRNS(png, info, nullptr, 0, &clear);
    if (gamma > 0.0) png_set_gAMA(png, info, gamma);
    png_write_info(png, info);
    std::vector<png_byte> pixels(std::size_t(height) * png_get_rowbytes(png, info));
    for (png_byte& byte : pixels) byte = next();
    std::vector<png_bytep> rows;
    for (int y = 0; y < height; ++y) rows.push_back(pixels.data() + std::size_t(y) * png_get_rowbytes(png, info));
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

TEST(Png, EveryFormIsReadLikeLibpngsSimplifiedReader) {
    const TestFolder folder;
    const std::filesystem::path path = folder / "noise.png";
    struct Form {
        int kind;
        std::vector<int> depths;
    };
    const Form forms[] = {{PNG_COLOR_TYPE_GRAY, {1, 2, 4, 8, 16}},
                          {PNG_COLOR_TYPE_PALETTE, {1, 2, 4, 8}},
                          {PNG_COLOR_TYPE_RGB, {8, 16}},
                          {PNG_COLOR_TYPE_GRAY_ALPHA, {8, 16}},
                          {PNG_COLOR_TYPE_RGB_ALPHA, {8, 16}}};
    for (const Form& form : forms)
        for (const int depth : form.depths)
            for (const bool interlaced : {false, true})
                for (const bool transparent : {false, true})
                    for (const double gamma : {0.0, 1.0, 0.45455}) {
                        if (transparent && (form.kind & PNG_COLOR_MASK_ALPHA) != 0) continue;
                        // libpng 1.6.39's simplified reader shuffles 16-bit interlaced files, so the reference is
                        // without interlacing.
                        write_noise(folder / "plain.png", 21, 13, depth, form.kind, false, transparent, gamma);
                        write_noise(path, 21, 13, depth, form.kind, interlaced, transparent, gamma);
                        const std::string which =
                            testing::PrintToString(std::tuple(form.kind, depth, interlaced, transparent, gamma));
                        const std::vector<std::uint8_t> expected = read_simply(folder / "plain.png");
                        EXPECT_EQ(read_png(path).pixels, expected) << which;
                        PngRows rows(path);
                        std::vector<std::uint8_t> by_row;
                        for (int y = 0; y < 13; ++y) {
                            const auto row = rows.next();
                            by_row.insert(by_row.end(), row.begin(), row.end());
                        }
                        EXPECT_EQ(by_row, expected) << which;
                    }
}

TEST(Png, RowByRowIsTheSamePicture) {
    const TestFolder folder;
    for (const auto& [width, height] : {std::pair{1, 1}, {40, 31}, {7, 32}, {33, 33}, {20, 100}}) {
        const Image image = colorful(width, height);
        PngRowWriter writer(folder / "rows.png", width, height);
        for (int y = 0; y < height; ++y) writer.add_row({image.at(0, y), 4 * std::size_t(width)});
        EXPECT_EQ(folder.files(), 1u) << "not under its name before it is whole";
        writer.finish();
        EXPECT_EQ(read_png(folder / "rows.png"), image) << width << " x " << height;
        std::filesystem::remove(folder / "rows.png");
    }
    { const PngRowWriter given_up(folder / "rows.png", 4, 4); }
    EXPECT_EQ(folder.files(), 0u);
}

TEST(Png, AFileThatIsNoPngIsNamed) {
    const TestFolder folder;
    EXPECT_NE(message_of(folder / "none.png").find("none.png: error: cannot be read: No such file"), std::string::npos);
    write_text(folder / "text.png", "not a picture");
    EXPECT_NE(message_of(folder / "text.png").find("text.png: error: not a whole PNG file"), std::string::npos);
    write_text(folder / "empty.png", "");
    EXPECT_NE(message_of(folder / "empty.png").find("not a whole PNG"), std::string::npos);
    std::filesystem::create_directory(folder / "folder.png");
    EXPECT_NE(message_of(folder / "folder.png").find("is a folder"), std::string::npos);
}

TEST(Png, EveryCutIsRefused) {
    const TestFolder folder;
    const std::vector<std::byte> bytes = encoded(colorful(20, 10));
    const std::string whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t n = 0; n < whole.size() - 12; n += 7) {  // the last 12 bytes are the end mark: no loss
        write_text(folder / "cut.png", whole.substr(0, n));
        EXPECT_NE(message_of(folder / "cut.png").find("not a whole PNG file"), std::string::npos) << n << " bytes";
    }
}

TEST(Png, NoChangedByteCrashes) {
    const TestFolder folder;
    const std::vector<std::byte> bytes = encoded(colorful(20, 10));
    const std::string whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t n = 0; n < whole.size(); ++n) {
        std::string broken = whole;
        broken[n] = char(~broken[n]);
        write_text(folder / "broken.png", broken);
        message_of(folder / "broken.png");  // an error or a picture; the sanitizers check
    }
}

TEST(Png, AHostileSizeIsRefusedBeforeMemoryIsTaken) {
    const TestFolder folder;
    const std::vector<std::byte> bytes = encoded(colorful(1, 1));
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const char huge[] = {0x00, 0x0f, 0x42, 0x40};  // 1,000,000, big-endian
    std::memcpy(&text[16], huge, 4);
    std::memcpy(&text[20], huge, 4);
    const auto checksum = [&] {
        std::uint32_t crc = 0xffffffffu;  // of the header chunk (PNG specification, annex D)
        for (std::size_t i = 12; i < 29; ++i) {
            crc ^= static_cast<std::uint8_t>(text[i]);
            for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
        }
        return ~crc;
    }();
    for (std::size_t i = 0; i < 4; ++i) text[29 + i] = char(checksum >> (24 - 8 * i));
    write_text(folder / "huge.png", text);
    EXPECT_NE(message_of(folder / "huge.png").find("too large (1000000 x 1000000"), std::string::npos)
        << message_of(folder / "huge.png");
}

}  // namespace
}  // namespace tumble::png_test
