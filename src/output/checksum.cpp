#include "output/checksum.h"

#include <isa-l/crc.h>

namespace tumble {

std::uint32_t crc32_of(std::uint32_t before, std::span<const std::byte> bytes) {
    return crc32_gzip_refl(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

}  // namespace tumble
