// How much pictures of scenes differ from references of 256 samples a pixel; no test, because it takes a minute each:
//   ninja picture_reference && tests/render/picture_reference TIME SIZE FOLDER SCENE...
// TIME: s, of the frame; SIZE: of its height, in parts of the scene's own; FOLDER: for the pictures, or - for none.
#include "accumulated.h"

#include "output/png_writer.h"
#include "presimulation/motion_camera.h"
#include "render/renderer.h"
#include "scene/load.h"
#include "sim/world.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

int main(int count, char** words) {
    using namespace tumble;
    if (count < 5) return std::fputs("usage: picture_reference TIME SIZE FOLDER SCENE...\n", stderr), 2;
    const double time = std::atof(words[1]), size = std::atof(words[2]);
    const std::string folder = words[3];
    for (int i = 4; i < count; ++i) {
        SceneDescription scene = framed(load_scene(words[i]), 1);
        scene.output.width = int(scene.output.width * size);
        scene.output.height = int(scene.output.height * size);
        World world(scene);
        while (world.snapshot().time < time) world.advance_frame();
        const Snapshot snapshot = world.snapshot();
        const Image picture = Renderer(scene).render(snapshot), reference = accumulated(scene, snapshot, 16);
        const Unlikeness found = unlikeness(reference, picture);
        const std::string name = std::filesystem::path(words[i]).stem().string();
        fmt::print("{:24} FLIP {:.4f}  largest {:3}  pixels above 16: {:5}, 32: {:4}, 64: {:3}\n", name,
                   found.mean_flip, found.largest, found.above[0], found.above[1], found.above[2]);
        std::fflush(stdout);
        if (folder == "-") continue;
        write_png(std::filesystem::path(folder) / (name + ".png"), picture);
        write_png(std::filesystem::path(folder) / (name + "_reference.png"), reference);
    }
}
