// Draws falling boxes with MuJoCo, like its own sample `record`: OSMesa, mjr_render, mjr_readPixels, and a pipe into
// ffmpeg. Boxes, camera, light, shadows, samples and the encoder's settings are those of the scenes in bench/render;
// all other settings of MuJoCo are its defaults.
//   bench_render_mujoco NX NY NZ SPACING SIZE HEIGHT WIDTHxHEIGHT FRAMES CLIP EYE.x EYE.y EYE.z
//                       TARGET.x TARGET.y TARGET.z [ORBIT [POSES]]
// ORBIT: angular velocity of the camera about the target, degrees/s, counterclockwise seen from above.
// With POSES there is no simulation: the file has 7 doubles (position, quaternion w x y z; z up) for each box and
// frame.
// MuJoCo 2.2 needs memory proportional to the square of its contacts: a thousand boxes in a heap are too many.
#include <GL/osmesa.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int fps = 60, steps_per_frame = 4;  // the step of the scenes: 1/240 s

struct Arguments {
    int count[3];
    double spacing, size, height;  // m: of the grid, of a box, of the lowest layer
    int width, height_pixels, frames;
    std::string clip, poses;
    double eye[3], target[3];  // m, y up as in the scenes
    double orbit;              // degrees/s
};

/// y up becomes z up: (x, y, z) to (x, -z, y).
std::array<double, 3> z_up(double x, double y, double z) { return {x, -z, y}; }

std::string text(const std::array<double, 3>& v) {
    std::ostringstream out;
    out << v[0] << ' ' << v[1] << ' ' << v[2];
    return out.str();
}

std::string model_of(const Arguments& a) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    const int boxes = a.count[0] * a.count[1] * a.count[2];
    const int contacts = a.poses.empty() ? boxes : 1;
    std::ostringstream xml;
    xml << "<mujoco><option timestep='" << 1.0 / (fps * steps_per_frame) << "' cone='elliptic'/><size nconmax='"
        << 10 * contacts << "' njmax='" << 30 * contacts << "' nstack='" << 100000 * boxes
        << "'/><visual><global offwidth='" << a.width << "' offheight='" << a.height_pixels
        << "'/><quality shadowsize='2048' offsamples='4'/></visual><asset>"
        << "<texture name='grid' type='2d' builtin='checker' width='512' height='512' rgb1='0.7 0.7 0.7' rgb2='0.6 0.6 "
           "0.6'/>"
        << "<material name='grid' texture='grid' texrepeat='1 1' texuniform='true'/></asset><worldbody>"
        << "<light directional='true' castshadow='true' pos='-6 6 14' dir='0.4 -0.3 -1'/>"
        << "<geom type='plane' size='40 40 1' material='grid' friction='0.7'/>";
    const char* colors[] = {"0.78 0.52 0.24", "0.85 0.63 0.36", "0.18 0.5 0.53",
                            "0.89 0.76 0.44", "0.71 0.32 0.23", "0.3 0.42 0.56"};
    for (int i = 0; i < boxes; ++i) {
        const int x = i % a.count[0], y = i / a.count[0] % a.count[1], z = i / (a.count[0] * a.count[1]);
        const auto place = [&](int k, int n) { return (k - 0.5 * (n - 1)) * a.spacing + 0.1 * part(random); };
        const auto at = z_up(place(x, a.count[0]), a.height + a.spacing * y, place(z, a.count[2]));
        const double half = 0.5 * a.size * (0.975 + 0.125 * part(random));
        xml << "<body pos='" << text(at) << "' euler='" << 60.0 * part(random) << ' ' << 60.0 * part(random)
            << " 0'><freejoint/><geom type='box' size='" << text({half, half, half}) << "' density='400' friction='0.6'"
            << (a.poses.empty() ? "" : " contype='0' conaffinity='0'") << " rgba='" << colors[i % 6] << " 1'/></body>";
    }
    xml << "</worldbody></mujoco>";
    return xml.str();
}

mjModel* load(const std::string& xml) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "scene.xml", int(xml.size()));
    std::memcpy(files->filedata[0], xml.data(), xml.size());
    char error[1000] = "";
    mjModel* model = mj_loadXML("scene.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (!model) throw std::runtime_error(error);
    return model;
}

/// The free camera looks at a point from a distance, an azimuth and an elevation.
mjvCamera camera_of(const Arguments& a, mjModel& model) {
    const auto eye = z_up(a.eye[0], a.eye[1], a.eye[2]), target = z_up(a.target[0], a.target[1], a.target[2]);
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    double way[3], squared = 0.0;
    for (int i = 0; i < 3; ++i) {
        camera.lookat[i] = target[std::size_t(i)];
        way[i] = target[std::size_t(i)] - eye[std::size_t(i)];
        squared += way[i] * way[i];
    }
    camera.distance = std::sqrt(squared);
    camera.azimuth = std::atan2(way[1], way[0]) * 180.0 / mjPI;
    camera.elevation = std::asin(way[2] / camera.distance) * 180.0 / mjPI;
    model.vis.global.fovy = 38.0f;
    return camera;
}

void run(const Arguments& a) {
    std::vector<unsigned char> unused(std::size_t(800) * 800 * 4);  // the default framebuffer of the sample
    OSMesaContext osmesa = OSMesaCreateContextExt(GL_RGBA, 24, 8, 8, nullptr);
    if (!osmesa || !OSMesaMakeCurrent(osmesa, unused.data(), GL_UNSIGNED_BYTE, 800, 800))
        throw std::runtime_error("no OSMesa context");
    mjModel* model = load(model_of(a));
    mjData* data = mj_makeData(model);
    mjvScene scene;
    mjrContext context;
    mjvOption option;
    mjv_defaultOption(&option);
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_makeScene(model, &scene, 4000);
    mjr_makeContext(model, &context, mjFONTSCALE_150);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    if (context.currentBuffer != mjFB_OFFSCREEN) throw std::runtime_error("no offscreen buffer");
    mjvCamera camera = camera_of(a, *model);
    const double azimuth = camera.azimuth;

    const char* encoder = std::getenv("BENCH_ENCODER");  // Tumble's, from scripts/bench-render
    if (!encoder) throw std::runtime_error("BENCH_ENCODER must hold ffmpeg's codec arguments");
    std::ostringstream command;
    command << "ffmpeg -v error -y -f rawvideo -pix_fmt rgb24 -video_size " << a.width << 'x' << a.height_pixels
            << " -framerate " << fps << " -i - -vf vflip " << encoder << " '" << a.clip << "'";
    std::FILE* pipe = popen(command.str().c_str(), "w");
    if (!pipe) throw std::runtime_error("no ffmpeg");
    const mjrRect view{0, 0, a.width, a.height_pixels};
    const std::size_t pixels = std::size_t(a.width) * std::size_t(a.height_pixels);
    std::vector<unsigned char> rgb(3 * pixels);
    std::vector<float> depth(pixels);  // the sample reads it as well
    std::FILE* poses = a.poses.empty() ? nullptr : std::fopen(a.poses.c_str(), "rb");
    if (!a.poses.empty() && !poses) throw std::runtime_error("no poses");
    for (int n = 0; n < a.frames; ++n) {
        if (poses) {
            if (std::fread(data->qpos, sizeof(double), std::size_t(model->nq), poses) != std::size_t(model->nq))
                throw std::runtime_error("too few poses");
            mj_kinematics(model, data);
            mj_camlight(model, data);
        } else if (n == 0) {
            mj_forward(model, data);
        } else {
            for (int i = 0; i < steps_per_frame; ++i) mj_step(model, data);
        }
        camera.azimuth = azimuth + a.orbit * n / fps;  // azimuth of the view direction, which rotates as the eye does
        mjv_updateScene(model, data, &option, nullptr, &camera, mjCAT_ALL, &scene);
        mjr_render(view, &scene, &context);
        mjr_readPixels(rgb.data(), depth.data(), view, &context);
        std::fwrite(rgb.data(), 1, rgb.size(), pipe);
    }
    if (poses) std::fclose(poses);
    if (pclose(pipe) != 0) throw std::runtime_error("ffmpeg failed");
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
    mj_deleteData(data);
    mj_deleteModel(model);
    OSMesaDestroyContext(osmesa);
}

}  // namespace

int main(int argc, char** argv) {
    Arguments a{};
    if (argc < 16 || argc > 18) {
        std::fprintf(stderr, "usage: see the head of bench/render_peers/mujoco.cpp\n");
        return 2;
    }
    for (int i = 0; i < 3; ++i) a.count[i] = std::atoi(argv[1 + i]);
    a.spacing = std::atof(argv[4]);
    a.size = std::atof(argv[5]);
    a.height = std::atof(argv[6]);
    if (std::sscanf(argv[7], "%dx%d", &a.width, &a.height_pixels) != 2) return 2;
    a.frames = std::atoi(argv[8]);
    a.clip = argv[9];
    for (int i = 0; i < 3; ++i) {
        a.eye[i] = std::atof(argv[10 + i]);
        a.target[i] = std::atof(argv[13 + i]);
    }
    if (argc > 16) a.orbit = std::atof(argv[16]);
    if (argc > 17) a.poses = argv[17];
    try {
        run(a);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
