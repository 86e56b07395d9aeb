#include "app/threads/thread_budget.h"

#include <algorithm>
#include <thread>

namespace tumble {
namespace {

// Threads that share a step wait for each other by spinning, on cores that drawing needs: a hundred boxes on two cores
// took 0.24 s of processor time for 151 frames with one thread, 0.42 s with two; a clip of a thousand took a tenth less
// with one.
constexpr std::size_t bodies_a_thread = 500;
constexpr std::size_t many_bodies = 5000;  // above this number a step takes so long that drawing would wait for it

}  // namespace

int machine_threads() { return std::clamp(int(std::thread::hardware_concurrency()), 1, most_threads); }

int simulation_threads_beside_drawing(std::size_t bodies, int cores) {
    const int most = bodies < many_bodies ? std::max(cores / 2, 1) : cores;
    return int(std::clamp<std::size_t>(bodies / bodies_a_thread, 1, std::size_t(most)));
}

}  // namespace tumble
