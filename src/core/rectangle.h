// A rectangle of pixels.
#pragma once

namespace tumble {

/// Pixels, from the top left corner of the image.
struct Rectangle {
    int x = 0, y = 0;
    int width = 0, height = 0;
    friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

}  // namespace tumble
