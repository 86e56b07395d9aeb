#include "app/compare/compared_folder.h"

#include "compare/image_folder.h"

namespace tumble {
namespace {

namespace fs = std::filesystem;

bool is_record(const fs::path& name) { return name.filename().string().ends_with(".motion.json"); }

}  // namespace

void add_compared_folder(const fs::path& folder, OutputPlan& plan) {
    for (const fs::path& file : files_in_folder(folder))
        if (is_record(file) || is_picture_name(file)) plan.add_input(file);
    plan.add_input_folder(
        folder, [](const fs::path& name) { return !is_hidden(name) && (is_picture_name(name) || is_record(name)); });
}

}  // namespace tumble
