// Arrays of numbers for NumPy's np.load(): an .npz file, which is a zip of .npy files, one per array
// (numpy.org/doc/stable/reference/generated/numpy.lib.format.html). Compressed by ISA-L in a fraction of zlib's time.
// The bytes depend on the arrays only: the file contains no date.
#pragma once

#include "output/deflater.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The dimensions of an array, the slowest first: {rows, columns, channels}.
using ArrayShape = std::vector<std::size_t>;

class NpzArchive {
public:
    /// Appends an array, in C order. Throws RunError if the values do not fit into the 4 GiB of a zip file.
    void add(std::string_view name, const ArrayShape& shape, std::span<const float> values);
    void add(std::string_view name, const ArrayShape& shape, std::span<const double> values);
    void add(std::string_view name, const ArrayShape& shape, std::span<const std::int32_t> values);
    void add(std::string_view name, const ArrayShape& shape, std::span<const std::uint8_t> values);

    /// The whole file, valid until the next call. The archive is empty again. With a mark (64
    /// characters), the file ends with a comment of it and a checksum.
    std::span<const std::byte> finish(std::string_view mark = {});

    /// Upper bound of the size of an array in a file, including the end of the file, bytes.
    static std::size_t bytes_bound(std::size_t bytes_of_values);

private:
    struct Member {
        std::string name;
        std::uint32_t checksum = 0, packed = 0, size = 0, offset = 0;
    };
    void add_bytes(std::string_view name, const std::string& kind, const ArrayShape& shape,
                   std::span<const std::byte> values);
    std::uint32_t compress(std::span<const std::byte> head, std::span<const std::byte> values);
    std::uint32_t compress_small(std::span<const std::byte> head, std::span<const std::byte> values);

    /// A small array of the previous file. Most of its time is that of a code, and it seldom changes.
    struct SmallArray {
        std::vector<std::byte> content, packed;
    };
    std::vector<SmallArray> small_;  // by the number of the array in the file
    Deflater deflater_;
    std::vector<std::byte> file_;
    std::size_t used_ = 0;  // written bytes of file_
    std::vector<Member> members_;
};

// The mark of an .npz file, and whether the file is whole, without unpacking it.

/// The zip comment of a marked file: the mark of 64 characters, and the CRC-32 of all bytes before the comment.
inline constexpr std::size_t npz_comment_size = 86;
std::string npz_comment(std::string_view mark, std::uint32_t checksum);

/// The mark of a file whose bytes all have the checksum in its comment; empty for a damaged, cut or unmarked file, or
/// where there is none.
std::optional<std::string> mark_of_whole_npz(const std::filesystem::path& path);

}  // namespace tumble
