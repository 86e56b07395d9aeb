#include "render/gl/shader_compile_schedule.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace tumble {
namespace {

using namespace std::chrono_literals;

constexpr auto between_looks = 500us;
// longer than the compilation of any shader: the other process has ended, or gets no processor time
constexpr auto longest_wait = 500ms;
constexpr auto until_on_disk = 3ms;  // Mesa writes its files in a thread of its own

}  // namespace

void ShaderCompileSchedule::run(std::span<const std::function<void()>> parts) {
    const std::size_t count = std::min(parts.size(), most);
    bool others = false;
    for (std::size_t i = 0; i < count; ++i) {
        unsigned char expected = open;
        if (!states_[i].compare_exchange_strong(expected, taken)) {
            others = true;
            continue;
        }
        parts[i]();
        states_[i] = done;
    }
    if (!others) return;
    const auto end = std::chrono::steady_clock::now() + longest_wait;
    const auto all_done = [&] {
        return std::all_of(states_.begin(), states_.begin() + std::ptrdiff_t(count),
                           [](const auto& s) { return s == done; });
    };
    while (!all_done() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(between_looks);
    std::this_thread::sleep_for(until_on_disk);
}

}  // namespace tumble
