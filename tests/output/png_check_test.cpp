// The mark of PNG files, and every damage of a byte.
#include "output/png_reader.h"
#include "output/png_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace tumble::png_check_test {
namespace {

const std::filesystem::path path = std::filesystem::temp_directory_path() / "tumble-png-check-test.png";
const std::string mark_text(64, 'a');

std::vector<std::byte> file_of(const std::string& text) {
    Image image(9, 40);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = std::uint8_t(i * 7);
    PngEncoder encoder(PngAlpha::dropped, text);
    const std::span<const std::byte> file = encoder.encode(image);
    return {file.begin(), file.end()};
}

/// Without waiting for the disk.
void write(std::span<const std::byte> bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

PngState state_of_bytes(std::span<const std::byte> bytes) {
    write(bytes);
    return state_of_png(path);
}

TEST(PngCheck, TheMark) {
    const std::vector<std::byte> marked = file_of(mark_text), plain = file_of("");
    EXPECT_EQ(marked.size(), plain.size() + 12 + 13 + mark_text.size());
    EXPECT_EQ(state_of_bytes(marked).mark, mark_text);
    EXPECT_TRUE(state_of_png(path).whole);
    EXPECT_EQ(mark_of_png(path), mark_text);
    const Image image = read_png(path);
    EXPECT_FALSE(state_of_bytes(plain).mark);
    EXPECT_TRUE(state_of_png(path).whole);
    EXPECT_EQ(read_png(path).pixels, image.pixels);
    std::filesystem::remove(path);
    EXPECT_FALSE(state_of_png(path).whole);
    EXPECT_FALSE(mark_of_png(path));
}

TEST(PngCheck, EveryDamageIsFound) {
    const std::vector<std::byte> file = file_of(mark_text);
    for (std::size_t i = 0; i < file.size(); ++i) {
        std::vector<std::byte> damaged = file;
        damaged[i] ^= std::byte(1 << i % 8);
        const PngState state = state_of_bytes(damaged);
        EXPECT_FALSE(state.whole) << i;
        EXPECT_FALSE(state_of_bytes(std::span(file).first(i)).whole) << i;
    }
    std::vector<std::byte> longer = file;
    longer.push_back({});
    EXPECT_FALSE(state_of_bytes(longer).whole);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace tumble::png_check_test
