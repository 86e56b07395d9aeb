// The table of `tumble simulate --breaks`.
#include "tumble/output.h"

#include "api/guard.h"
#include "api/record_table.h"
#include "api/scene_data.h"

namespace tumble::v0 {

struct BreakTable::State : Writing {
    State(const std::string& file, const Scene& whole)
        : scene(whole), table(file, "time,body,bond,area,tension,bending,shear,torsion,energy,pieces") {}

    Scene scene;
    RecordTable table;
};

BreakTable::BreakTable(const std::string& file, const Scene& scene) {
    guarded([&] { state_ = std::make_unique<State>(file, scene); });
}
BreakTable::~BreakTable() = default;
BreakTable::BreakTable(BreakTable&&) noexcept = default;
BreakTable& BreakTable::operator=(BreakTable&&) noexcept = default;

void BreakTable::add(const std::vector<Break>& breaks) {
    write_with(state_, "BreakTable", [&](State& state) {
        RecordTable& table = state.table;
        for (const Break& b : breaks) {
            table.number(b.time).text(state.scene.body_name(b.body)).integer(std::int64_t(b.bond)).number(b.area);
            table.number(b.tension).number(b.bending).number(b.shear).number(b.torsion).number(b.energy);
            table.integer(std::int64_t(b.pieces));
            table.end_row();
        }
    });
}

void BreakTable::finish() {
    finish_with(state_, "BreakTable", [](State& state) { state.table.finish(); });
}

}  // namespace tumble::v0
