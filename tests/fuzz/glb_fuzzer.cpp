#include "mesh_fuzzer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return tumble::fuzz_mesh(".glb", data, size);
}
