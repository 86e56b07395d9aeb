// The mark of .npz files, and every damage of a byte.
#include "output/npz_archive.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace tumble::npz_check_test {
namespace {

const std::filesystem::path path = std::filesystem::temp_directory_path() / "tumble-npz-check-test.npz";
const std::string mark_text(64, 'b');

std::vector<std::byte> file_of(const std::string& text) {
    NpzArchive archive;
    archive.add("depth", {2, 3}, std::vector<float>{1, 2, 3, 4, 5, 6});
    archive.add("albedo", {4}, std::vector<std::uint8_t>{1, 2, 3, 4});
    const std::span<const std::byte> file = archive.finish(text);
    return {file.begin(), file.end()};
}

/// Without waiting for the disk.
void write(std::span<const std::byte> bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

std::optional<std::string> mark_of(std::span<const std::byte> bytes) {
    write(bytes);
    return mark_of_whole_npz(path);
}

TEST(NpzCheck, MarkAndDamage) {
    const std::vector<std::byte> file = file_of(mark_text);
    EXPECT_EQ(mark_of(file), mark_text);
    EXPECT_FALSE(mark_of(file_of("")));
    for (std::size_t i = 0; i < file.size(); ++i) {
        std::vector<std::byte> damaged = file;
        damaged[i] ^= std::byte(1 << i % 8);
        EXPECT_NE(mark_of(damaged), mark_text) << i;
        EXPECT_FALSE(mark_of(std::span(file).first(i))) << i;
    }
    std::filesystem::remove(path);
    EXPECT_FALSE(mark_of_whole_npz(path));
}

}  // namespace
}  // namespace tumble::npz_check_test
