// Distributed shader compilation: each shader once, by any process, with the same image.
#include "drawing.h"
#include "example_scenes.h"

#include "render/gl/shader_compile_schedule.h"

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <new>
#include <thread>
#include <vector>

namespace tumble::shader_compile_schedule_test {
namespace {

constexpr std::size_t parts = 12;

struct Shared {
    ShaderCompileSchedule turns;
    std::array<std::atomic<int>, parts> runs{}, early{};
    std::atomic<bool> first_taken{false};
};

class Turns : public testing::Test {
protected:
    Turns() {
        void* const memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        shared_ = new (memory) Shared;
    }
    ~Turns() override { munmap(shared_, sizeof(Shared)); }

    std::vector<std::function<void()>> counted() {
        std::vector<std::function<void()>> all;
        for (std::size_t i = 0; i < parts; ++i)
            all.emplace_back([this, i] {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                ++shared_->runs[i];
            });
        return all;
    }

    Shared* shared_;
};

TEST_F(Turns, EachPartRunsInOneProcessAndAllWaitForIt) {
    std::vector<pid_t> children;
    for (int child = 0; child < 3; ++child) {
        const pid_t id = fork();
        if (id == 0) {
            shared_->turns.run(counted());
            for (std::size_t i = 0; i < parts; ++i)
                if (shared_->runs[i] == 0) ++shared_->early[i];
            _exit(0);
        }
        children.push_back(id);
    }
    for (const pid_t id : children) waitpid(id, nullptr, 0);
    for (std::size_t i = 0; i < parts; ++i) {
        EXPECT_EQ(shared_->runs[i], 1) << i;
        EXPECT_EQ(shared_->early[i], 0) << i;
    }
}

TEST_F(Turns, ADeadProcessIsNotWaitedForWithoutEnd) {
    const pid_t id = fork();
    if (id == 0) {
        const std::function<void()> part = [] { _exit(0); };
        shared_->turns.run({&part, 1});
    }
    waitpid(id, nullptr, 0);
    shared_->turns.run(counted());  // comes back
    EXPECT_EQ(shared_->runs[0], 0);
    EXPECT_EQ(shared_->runs[1], 1);
}

TEST_F(Turns, PartsBeyondTheMostAreLeftOut) {
    int runs = 0;
    const std::vector<std::function<void()>> all(ShaderCompileSchedule::most + 3, [&] { ++runs; });
    shared_->turns.run(all);
    EXPECT_EQ(runs, int(ShaderCompileSchedule::most));
}

TEST_F(Turns, ThePictureIsTheSame) {
    for (const int samples : {1, 4}) {
        SceneDescription scene = empty_scene();
        scene.output.samples = samples;
        scene.bodies.push_back(ground_plane({176, 180, 184}, Pattern::grid));
        scene.bodies.push_back(box_body(Vec3(0.0, 0.8, 0.0), Vec3(1.0, 1.0, 1.0), {200, 120, 40}));
        scene.bodies.push_back(ball_body(Vec3(1.2, 1.4, 0.3), 0.5, {40, 120, 200}));
        scene.bodies.push_back(mesh_body(Vec3(-1.2, 1.4, 0.3), torus_asset(0.5, 0.2), {90, 160, 60}));
        const Image alone = drawn(scene);
        RenderSwitches options;
        ShaderCompileSchedule turns;
        options.compile_schedule = &turns;
        EXPECT_EQ(drawn(scene, options).pixels, alone.pixels);
    }
}

}  // namespace
}  // namespace tumble::shader_compile_schedule_test
