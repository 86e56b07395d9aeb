// Pictures that come back when their last reader lets go: a clip of any length uses a dozen of them.
#pragma once

#include "core/image.h"

#include <memory>

namespace tumble {

class ImagePool {
public:
    ImagePool();
    /// A picture of any size and content. May outlive the pool.
    std::shared_ptr<Image> take();

private:
    struct Shelf;
    std::shared_ptr<Shelf> shelf_;
};

}  // namespace tumble
