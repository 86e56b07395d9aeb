// A peer's program runs every benchmark: bench_X [accuracy | contact | joints | stability] OPTIONS...
#pragma once

#include "accuracy/program.h"
#include "contact/program.h"
#include "joints/program.h"
#include "stability/program.h"

#include <string_view>

namespace tumble::bench {

struct Peer {
    std::string name;
    std::vector<Variant> accuracy;
    std::vector<Way> contact;
    std::vector<StabilityWay> stability;
    std::vector<JointWay> joints;
};

inline int run_peer(int argc, char** argv, const Peer& peer) {
    const std::string_view first = argc > 1 ? argv[1] : "";
    if (first == "contact") return run_contact(argc - 1, argv + 1, peer.name, peer.contact);
    if (first == "joints") return run_joints(argc - 1, argv + 1, peer.name, peer.joints);
    if (first == "stability") return run_stability(argc - 1, argv + 1, peer.name, peer.stability);
    if (first == "accuracy") return run_accuracy(argc - 1, argv + 1, peer.name, peer.accuracy);
    return run_accuracy(argc, argv, peer.name, peer.accuracy);
}

}  // namespace tumble::bench
