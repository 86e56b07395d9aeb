#include "app/files/aov_folder.h"

#include "app/files/frame_folder.h"
#include "output/file_bytes.h"
#include "output/table_writer.h"
#include "render/aov/shape_instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace tumble {

std::filesystem::path aov_path(const std::filesystem::path& folder, std::int64_t frame) {
    return folder / fmt::format("aov_{:06}.npz", frame);
}

std::vector<std::int64_t> aovs_in(const std::filesystem::path& folder) { return numbers_in(folder, "aov_", ".npz"); }

std::filesystem::path segmentation_table_path(const std::filesystem::path& folder) {
    return folder / "segmentation.csv";
}

void AovFolder::set_manifest(const std::filesystem::path& path, std::string text) {
    manifest_path_ = path;
    manifest_ = std::move(text);
}

void AovFolder::write_manifest() {
    if (std::exchange(begun_, true)) return;
    if (aovs_.has(Aov::segmentation)) write_table();
    if (!manifest_.empty() && bytes_of_file(manifest_path_) != manifest_) write_file(manifest_path_, manifest_);
}

std::unique_ptr<TemporaryFile> AovFolder::write(std::int64_t frame, std::span<const std::byte> file) {
    auto part = std::make_unique<TemporaryFile>(aov_path(folder_, frame), LeftParts::kept);
    part->write(file);
    write_manifest();  // after that: a full disk leaves an empty folder
    return part;
}

/// One row per number: 0 is the background; bodies and cords by their index in the scene; then the water. Pieces have a
/// parent, the body that was cut.
void AovFolder::write_table() const {
    const bool cut =
        std::ranges::any_of(scene_.bodies, [](const BodyDescription& body) { return body.piece_of.has_value(); });
    TableWriter table(segmentation_table_path(folder_), cut ? "id,kind,index,name,parent" : "id,kind,index,name");
    const auto end_row = [&](std::string_view parent = "") {
        if (cut) table.text(parent);
        table.end_row();
    };
    table.integer(0).text("background").text("").text("");
    end_row();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
        const BodyDescription& body = scene_.bodies[i];
        table.integer(body_id(i)).text("body").integer(std::int64_t(i)).text(body.name);
        end_row(body.piece_of ? std::string_view(scene_.bodies[*body.piece_of].name) : "");
    }
    for (std::size_t i = 0; i < scene_.cords.size(); ++i) {
        table.integer(cord_id(scene_, i)).text("cord").integer(std::int64_t(i)).text("");
        end_row();
    }
    if (shows_water(scene_)) {
        table.integer(water_id(scene_)).text("water").integer(0).text("");
        end_row();
    }
    table.finish();
}

}  // namespace tumble
