// Memory aligned for the widest kernel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

class AlignedFloats {
public:
    void resize(std::size_t count) {
        if (memory_.size() < count + 16) memory_.resize(count + 16);
        data_ = memory_.data() + (64 - reinterpret_cast<std::uintptr_t>(memory_.data()) % 64) % 64 / sizeof(float);
    }
    float* data() { return data_; }

private:
    std::vector<float> memory_;
    float* data_ = nullptr;
};

}  // namespace tumble
