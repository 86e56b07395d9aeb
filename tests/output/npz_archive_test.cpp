// The bytes of an .npz archive, parsed by the specifications of zip (PKWARE's APPNOTE 6.3) and .npy.
#include "output/npz_archive.h"

#include "inflated.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <map>

namespace tumble::npz_archive_test {
namespace {

std::uint32_t number(std::span<const std::byte> bytes, std::size_t at, int size) {
    std::uint32_t value = 0;
    for (int i = size - 1; i >= 0; --i) value = value << 8 | std::uint32_t(bytes[at + std::size_t(i)]);
    return value;
}

std::string text(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
    return {reinterpret_cast<const char*>(bytes.data()) + at, size};
}

/// The members by name, found through the directory at the end; their checksums must be right.
std::map<std::string, std::string> members(std::span<const std::byte> file) {
    std::map<std::string, std::string> found;
    const std::size_t end = file.size() - 22;
    EXPECT_EQ(number(file, end, 4), 0x06054b50u);
    std::size_t at = number(file, end + 16, 4);
    EXPECT_EQ(at + number(file, end + 12, 4), end) << "the directory ends where the end begins";
    for (std::uint32_t left = number(file, end + 10, 2); left > 0; --left) {
        EXPECT_EQ(number(file, at, 4), 0x02014b50u);
        const std::uint32_t checksum = number(file, at + 16, 4), packed = number(file, at + 20, 4);
        const std::uint32_t size = number(file, at + 24, 4), name_size = number(file, at + 28, 2);
        const std::uint32_t local = number(file, at + 42, 4);
        const std::string name = text(file, at + 46, name_size);
        EXPECT_EQ(number(file, local, 4), 0x04034b50u);
        // The local header has the same values: method, date, checksum, sizes.
        for (std::size_t i = 0; i < 22; ++i) EXPECT_EQ(file[local + 4 + i], file[at + 6 + i]) << name << i;
        EXPECT_EQ(text(file, local + 30, name_size), name);

        SCOPED_TRACE(name);
        const std::vector<std::byte> unpacked = inflated(file.subspan(local + 30 + name_size, packed), size);
        EXPECT_EQ(unpacked.size(), size);
        EXPECT_EQ(crc32(0, reinterpret_cast<const Bytef*>(unpacked.data()), size), checksum);
        found[name] = text(unpacked, 0, unpacked.size());
        at += 46 + name_size;
    }
    EXPECT_EQ(at, end);
    return found;
}

/// The header of an .npy file, and its values.
std::pair<std::string, std::string> npy(const std::string& file) {
    EXPECT_EQ(file.substr(0, 8), std::string("\x93NUMPY\x01\0", 8));
    const auto size = std::size_t(static_cast<unsigned char>(file[8]) + 256 * static_cast<unsigned char>(file[9]));
    EXPECT_EQ((10 + size) % 64, 0u);
    std::string words = file.substr(10, size);
    EXPECT_EQ(words.back(), '\n');
    words.erase(words.find_last_not_of(" \n") + 1);
    return {words, file.substr(10 + size)};
}

template <class Value>
std::vector<Value> values_of(const std::string& bytes) {
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

TEST(NpzArchive, HoldsArraysOfAllKinds) {
    std::vector<float> floats;
    for (int i = 0; i < 1000 * 7; ++i) floats.push_back(std::sin(float(i)) / float(i));  // the first is NaN
    const std::vector<double> doubles = {0.1, -1e300};
    const std::vector<std::int32_t> numbers(50000, 70000);
    const std::vector<std::uint8_t> bytes = {1, 2, 3, 4, 5, 6};
    NpzArchive archive;
    archive.add("floats", {1000, 7}, floats);
    archive.add("doubles", {2}, doubles);
    archive.add("numbers", {500, 100}, numbers);
    archive.add("bytes", {1, 2, 3}, bytes);
    const auto found = members(archive.finish());
    ASSERT_EQ(found.size(), 4u);
    const auto [words, values] = npy(found.at("floats.npy"));
    EXPECT_EQ(words, "{'descr': '<f4', 'fortran_order': False, 'shape': (1000, 7, ), }");
    ASSERT_EQ(values.size(), 4 * floats.size());
    EXPECT_EQ(std::memcmp(values.data(), floats.data(), values.size()), 0);
    EXPECT_EQ(npy(found.at("doubles.npy")).first, "{'descr': '<f8', 'fortran_order': False, 'shape': (2, ), }");
    EXPECT_EQ(values_of<double>(npy(found.at("doubles.npy")).second), doubles);
    EXPECT_EQ(npy(found.at("numbers.npy")).first, "{'descr': '<i4', 'fortran_order': False, 'shape': (500, 100, ), }");
    EXPECT_EQ(values_of<std::int32_t>(npy(found.at("numbers.npy")).second), numbers);
    EXPECT_EQ(npy(found.at("bytes.npy")).first, "{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2, 3, ), }");
    EXPECT_EQ(values_of<std::uint8_t>(npy(found.at("bytes.npy")).second), bytes);
}

TEST(NpzArchive, FilesAreIndependent) {
    const std::vector<std::uint8_t> small = {1, 2, 3}, large(100000, 9);
    NpzArchive fresh, used;
    used.add("large", {100000}, large);
    used.finish();
    for (NpzArchive* archive : {&fresh, &used}) archive->add("small", {3}, small);
    const auto a = fresh.finish(), b = used.finish();
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    EXPECT_EQ(members(b).size(), 1u);
}

TEST(NpzArchive, ASmallArrayOfTheFileBeforeIsTakenOnlyIfItIsTheSame) {
    NpzArchive used;
    const auto file = [&](NpzArchive& archive, double second, std::uint8_t fill) {
        archive.add("first", {2}, std::vector<double>{1.0, second});
        archive.add("middle", {5000}, std::vector<std::uint8_t>(5000, fill));
        archive.add("last", {1}, std::vector<double>{second});
        const auto bytes = archive.finish();
        return std::vector<std::byte>(bytes.begin(), bytes.end());
    };
    for (const double second : {2.0, 2.0, 3.0, 2.0}) {
        NpzArchive fresh;
        EXPECT_EQ(file(used, second, std::uint8_t(second)), file(fresh, second, std::uint8_t(second)));
    }
    NpzArchive fresh;
    for (NpzArchive* archive : {&fresh, &used}) archive->add("other", {2}, std::vector<float>{1.0f, 2.0f});
    const auto a = fresh.finish(), b = used.finish();
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

TEST(NpzArchive, TheBoundHoldsForIncompressibleData) {
    std::uint32_t state = 1;
    for (const std::size_t size : {1u, 1000u, 300000u}) {
        std::vector<std::uint8_t> noise(size);
        for (std::uint8_t& value : noise) value = std::uint8_t((state = state * 1664525u + 1013904223u) >> 24);
        NpzArchive archive;
        archive.add("noise", {size}, noise);
        const auto file = archive.finish();
        EXPECT_LE(file.size(), NpzArchive::bytes_bound(size));
        EXPECT_EQ(values_of<std::uint8_t>(npy(members(file).at("noise.npy")).second), noise);
    }
}

}  // namespace
}  // namespace tumble::npz_archive_test
