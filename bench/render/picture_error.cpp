#include "render/picture_error.h"

#include <cmath>

namespace tumble::bench {
namespace {

constexpr double edge_spread = 8.0;  // levels
constexpr int window = 8;            // pixels

// ITU-R BT.709
double brightness(const std::uint8_t* p) { return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]; }

}  // namespace

void PictureMean::add(const Image& image) {
    width_ = image.width;
    height_ = image.height;
    sum_.resize(image.pixels.size());
    squares_.resize(2 * image.pixels.size() / 4);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) sum_[i] += image.pixels[i];
    for (std::size_t i = 0; i < image.pixels.size() / 4; ++i) {
        const double value = brightness(&image.pixels[4 * i]);
        squares_[2 * i] += value;
        squares_[2 * i + 1] += value * value;
    }
    ++count_;
}

Image PictureMean::mean() const {
    Image image(width_, height_);
    for (std::size_t i = 0; i < sum_.size(); ++i) image.pixels[i] = std::uint8_t(std::lround(sum_[i] / count_));
    return image;
}

std::vector<bool> PictureMean::edges() const {
    std::vector<bool> edges;
    for (std::size_t i = 0; i < squares_.size(); i += 2) {
        const double mean = squares_[i] / count_, variance = squares_[i + 1] / count_ - mean * mean;
        edges.push_back(variance > edge_spread * edge_spread);
    }
    return edges;
}

double rms_difference(const Image& a, const Image& b, const std::vector<bool>& chosen) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (!chosen[i]) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const double d = double(a.pixels[4 * i + c]) - double(b.pixels[4 * i + c]);
            sum += d * d;
        }
        count += 3;
    }
    return count > 0 ? std::sqrt(sum / double(count)) : 0.0;
}

double structural_similarity(const Image& a, const Image& b) {
    constexpr double c1 = (0.01 * 255.0) * (0.01 * 255.0), c2 = (0.03 * 255.0) * (0.03 * 255.0);
    double total = 0.0;
    std::size_t windows = 0;
    for (int top = 0; top + window <= a.height; top += 2)
        for (int left = 0; left + window <= a.width; left += 2) {
            double sa = 0.0, sb = 0.0, saa = 0.0, sbb = 0.0, sab = 0.0;
            for (int y = top; y < top + window; ++y)
                for (int x = left; x < left + window; ++x) {
                    const double p = brightness(a.at(x, y)), q = brightness(b.at(x, y));
                    sa += p, sb += q, saa += p * p, sbb += q * q, sab += p * q;
                }
            constexpr double n = window * window;
            const double ma = sa / n, mb = sb / n;
            const double va = saa / n - ma * ma, vb = sbb / n - mb * mb, cov = sab / n - ma * mb;
            total += (2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
            ++windows;
        }
    return total / double(windows);
}

}  // namespace tumble::bench
