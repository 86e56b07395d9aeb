// Draws golden cases as `tumble render` and `tumble plot` do.
#pragma once

#include "app/golden/drawer.h"

namespace tumble {

class SceneDrawer : public CaseDrawer {
public:
    std::string identity(const GoldenCase& golden) const override;
    void draw(const GoldenCase& golden, const std::filesystem::path& folder, const DrawingWork& work) const override;
};

}  // namespace tumble
