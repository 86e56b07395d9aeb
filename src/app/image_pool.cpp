#include "app/image_pool.h"

#include <mutex>
#include <utility>
#include <vector>

namespace tumble {

struct ImagePool::Shelf {
    std::mutex mutex;
    std::vector<std::unique_ptr<Image>> images;

    void put_back(std::unique_ptr<Image> image) {
        const std::lock_guard lock(mutex);
        images.push_back(std::move(image));
    }
};

ImagePool::ImagePool() : shelf_(std::make_shared<Shelf>()) {}

std::shared_ptr<Image> ImagePool::take() {
    std::unique_ptr<Image> image;
    {
        const std::lock_guard lock(shelf_->mutex);
        if (!shelf_->images.empty()) {
            image = std::move(shelf_->images.back());
            shelf_->images.pop_back();
        }
    }
    if (!image) image = std::make_unique<Image>();
    return {image.release(), [shelf = shelf_](Image* back) { shelf->put_back(std::unique_ptr<Image>(back)); }};
}

}  // namespace tumble
