// One frame of a scene file, for a golden-image test: golden_frame SCENE.toml FRAME OUT.png [GOLDEN.png]
// Exit code 0: the frame is written, and it looks like the golden image, where one is given. 1: it looks different.
#include <tumble/tumble.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc < 4 || argc > 5) {
        std::fprintf(stderr, "usage: golden_frame SCENE.toml FRAME OUT.png [GOLDEN.png]\n");
        return 2;
    }
    try {
        const tumble::Scene scene = tumble::load_scene(argv[1]);
        const long long wanted = std::atoll(argv[2]);
        tumble::World world(scene);
        tumble::Renderer renderer(scene);
        // The frames before are skipped, not left out: the frame then has the bytes of `tumble render --frames`.
        for (long long frame = 0; frame < wanted; ++frame) {
            renderer.skip(world.snapshot());
            world.advance_frame();
        }
        const tumble::Image image = renderer.render(world.snapshot());
        tumble::write_png(argv[3], image);
        if (argc < 5) return 0;
        const tumble::Comparison comparison = tumble::compare_images(tumble::read_png(argv[4]), image);
        if (!comparison.alike) std::fprintf(stderr, "%s differs: %s\n", argv[3], comparison.reason.c_str());
        return comparison.alike ? 0 : 1;
    } catch (const tumble::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.kind() == tumble::ErrorKind::input ? 2 : 1;
    }
}
