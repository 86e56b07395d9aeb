// Takes pictures under test as references.
#pragma once

#include "compare/comparison.h"
#include "compare/pair_compare.h"
#include "output/file_transaction.h"

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

namespace tumble {

/// Pictures that become references together. It writes picture files below the reference folder only, and through no
/// link.
class AcceptedPictures {
public:
    /// With a platform, its folder gets the references.
    AcceptedPictures(const std::filesystem::path& folder, const std::optional<std::string>& platform)
        : folder_(folder), platform_(platform), files_(folder, InnerLinks::refused) {}

    /// Takes the picture of a pair that is not alike, if it can be read, and marks the result. For several threads.
    /// Throws InputError if its reference is a link, or no file; RunError.
    void take(const ImagePair& pair, ImageResult& result);

    /// Gives all of them their names. Throws RunError.
    void commit() { files_.commit(); }

private:
    std::filesystem::path name_of(const ImagePair& pair) const;

    std::filesystem::path folder_;
    std::optional<std::string> platform_;
    std::mutex mutex_;
    FileTransaction files_;
};

}  // namespace tumble
