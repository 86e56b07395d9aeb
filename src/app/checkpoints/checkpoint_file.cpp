#include "app/checkpoints/checkpoint_file.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "sim/checkpoint/archive.h"

#include <fmt/format.h>

#include <cstring>

namespace tumble {

std::string difference(const CheckpointIdentity& there, const CheckpointIdentity& here) {
    for (const auto& [name, own] : here) {
        const std::string* const found = find_value(there, name);
        const std::string other = found == nullptr ? "none" : *found;
        if (other != own) return fmt::format("{}: {} there, {} here", name, safe_text(other), safe_text(own));
    }
    return there.size() == here.size() ? "" : "the number of settings";
}

namespace {

constexpr char magic[] = {'T', 'U', 'M', 'B', 'L', 'E', 'C', 'P'};
constexpr std::size_t sum_size = sizeof(std::uint64_t);

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw InputError({safe_path(file), 0, 0}, why);
}

}  // namespace

std::vector<std::byte> checkpoint_bytes(const CheckpointHeader& header, std::span<const std::byte> content) {
    CheckpointWriter writer;
    writer.keep(magic, header);
    writer.any(std::uint64_t(content.size()));
    std::vector<std::byte> bytes;
    bytes.reserve(writer.bytes().size() + content.size() + sum_size);
    bytes.assign(writer.bytes().begin(), writer.bytes().end());
    bytes.insert(bytes.end(), content.begin(), content.end());
    const std::uint64_t sum = crc64(bytes);
    bytes.resize(bytes.size() + sum_size);
    std::memcpy(bytes.data() + bytes.size() - sum_size, &sum, sum_size);
    return bytes;
}

std::vector<std::byte> checkpoint_content(const std::filesystem::path& file, std::span<const std::byte> bytes,
                                          const CheckpointHeader& expected) {
    if (bytes.size() < sizeof magic + sum_size || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
        refuse(file, "is no checkpoint of tumble simulate --checkpoints");
    const auto summed = bytes.first(bytes.size() - sum_size);
    std::uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + summed.size(), sum_size);
    if (sum != crc64(summed)) refuse(file, "the checkpoint is damaged: its checksum is wrong; simulate again");

    CheckpointReader reader(summed.subspan(sizeof magic));
    std::uint32_t format = 0;
    reader.any(format);
    if (format != expected.format)
        refuse(file, fmt::format("the checkpoint has format {}, and this program reads format {}; simulate again",
                                 format, expected.format));
    reader = CheckpointReader(summed.subspan(sizeof magic));
    CheckpointHeader header;
    std::uint64_t size = 0;
    reader.keep(header);
    reader.any(size);
    if (header.program != expected.program)
        refuse(file, fmt::format("the checkpoint is of tumble {}, and this is tumble {}; simulate again",
                                 safe_text(header.program), expected.program));
    if (header.kind != expected.kind || header.frame != expected.frame)
        refuse(file, fmt::format("holds the {} of frame {}, not the {} of frame {}: was the file renamed?",
                                 safe_text(header.kind), header.frame, expected.kind, expected.frame));
    if (const std::string differs = difference(header.identity, expected.identity); !differs.empty())
        refuse(file, fmt::format("the checkpoint is of another clip. It differs in {}", differs));
    if (size > summed.size()) refuse(file, "the checkpoint is damaged: it ends early");
    const auto content = summed.last(size);
    return {content.begin(), content.end()};
}

std::vector<std::byte> read_checkpoint(const std::filesystem::path& file, const CheckpointHeader& expected) {
    const std::string bytes = read_input_file(file, "the checkpoint");
    return checkpoint_content(file, std::as_bytes(std::span(bytes)), expected);
}

}  // namespace tumble
