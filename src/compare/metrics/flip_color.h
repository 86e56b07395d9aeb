// The colors of FLIP: from sRGB to the opponent colors in which the eye's filters work, and the difference of two
// filtered colors (Andersson et al. 2020, secs. 4.1 and 4.3).
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble {

/// Rows of YCxCz without its scales: Y = 116 y - 16, Cx = 500 x_y, Cz = 200 y_z. The filters are linear and have a
/// sum of 1, so the scales would cancel.
struct OpponentRow {
    float *y, *x_y, *y_z;  // Y/Yn; X/Xn - Y/Yn; Y/Yn - Z/Zn of the white n
};

/// `count` pixels from column `first` on, of a row of four bytes per pixel, which has `width` of them. Columns outside
/// have the color of the nearest inside. The color is seen on a background of the level `background` as far as alpha is
/// below 255.
struct PixelRow {
    const std::uint8_t* pixels;
    int width, first;
    std::size_t count;
    std::uint8_t background;
};

class OpponentColors {
public:
    OpponentColors();
    void convert(const PixelRow& from, const OpponentRow& to) const;

private:
    float linear_[256];  // of each sRGB level
};

/// Filtered rows of one image.
struct FilteredRow {
    const float *y, *x_y, *y_z[2];     // opponent colors; y_z is the sum of two
    const float *dx, *dy, *dxx, *dyy;  // derivatives of y: edges, points
};

/// The FLIP of each pixel of two rows.
void flip_row(const FilteredRow& a, const FilteredRow& b, std::size_t count, float* to);

}  // namespace tumble
