// A file of a checkpoint: the clip that it belongs to, its content, and a checksum over all bytes before it
// (docs/reference/checkpoints.md).
#pragma once

#include "app/files/named_values.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tumble {

// The clip that checkpoints belong to: by name, all that the state of a clip depends on. A run of another clip is
// refused with the first value that differs.

/// Scene and settings, as in ("the size", "1280x720"), the most telling ones first. The last one is a sum over all of
/// the scene.
using CheckpointIdentity = NamedValues;

/// "the size: 640x360 there, 1280x720 here" of the first value that differs; empty if all are equal.
std::string difference(const CheckpointIdentity& there, const CheckpointIdentity& here);

/// Version of the layout of all files and of the states in them: a new one reads no old file.
inline constexpr std::uint32_t checkpoint_format = 3;

struct CheckpointHeader {
    std::uint32_t format = checkpoint_format;
    std::string program;  // its version
    std::string kind;     // "state", "motion of panel 2" or "clip"
    std::int64_t frame = 0;
    CheckpointIdentity identity;

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [format, program, kind, frame, identity] = self;
        archive.any(format, frame);
        archive.keep(program, kind, identity);
    }
};

std::vector<std::byte> checkpoint_bytes(const CheckpointHeader& header, std::span<const std::byte> content);

/// The content of such bytes. Throws InputError, with the file's name, where the bytes are damaged or are no
/// checkpoint, and where the header is not that of `expected`.
std::vector<std::byte> checkpoint_content(const std::filesystem::path& file, std::span<const std::byte> bytes,
                                          const CheckpointHeader& expected);

/// The same of a file.
std::vector<std::byte> read_checkpoint(const std::filesystem::path& file, const CheckpointHeader& expected);

}  // namespace tumble
