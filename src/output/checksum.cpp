#include "output/checksum.h"

#include <isa-l/crc.h>
#include <isa-l/crc64.h>

namespace tumble {

std::uint32_t crc32_of(std::uint32_t before, std::span<const std::byte> bytes) {
    return crc32_gzip_refl(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

std::uint64_t crc64(std::span<const std::byte> bytes) {
    return crc64_ecma_refl(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

}  // namespace tumble
