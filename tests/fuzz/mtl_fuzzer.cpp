// The text of an MTL file, in a folder with an image: the result are materials or a MeshError.
#include "mesh_fuzzer.h"

#include "scene/mesh/mesh_readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    tumble::MeshImages images(tumble::fuzzed_folder().path());
    std::map<std::string, tumble::MeshMaterial, std::less<>> materials;
    try {
        tumble::read_mtl({reinterpret_cast<const char*>(data), size}, images, materials);
    } catch (const tumble::MeshError&) {
    }
    return 0;
}
