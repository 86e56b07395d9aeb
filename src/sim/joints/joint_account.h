// The account of a joint: its impulses for the tables of forces, and its work for the table of energies.
#pragma once

#include "core/vector.h"

namespace tumble {

/// Work of a joint's laws since the start of the account, J: the impulse of each row times the mean of its speeds
/// before and after, so that the sum is the change of kinetic energy.
struct JointWork {
    double motors = 0.0;    // by motors on the bodies, and in springs of joints that begin to hold later
    double carriers = 0.0;  // by kinematic bodies, through the joint
    double springs = 0.0;   // by springs with their dampers, and by the armature, on the bodies
    double heat = 0.0;      // lost by dry friction and by breaking
    double impacts = 0.0;   // lost at limits, and by joints that catch their bodies in motion
    double stored = 0.0;    // given into springs and armature: at the start, and by joints that begin to hold later

    void add(const JointWork& other) {
        motors += other.motors;
        carriers += other.carriers;
        springs += other.springs;
        heat += other.heat;
        impacts += other.impacts;
        stored += other.stored;
    }
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [motors, carriers, springs, heat, impacts, stored] = self;
        archive.keep(motors, carriers, springs, heat, impacts, stored);
    }
};

/// Impulses on B, the opposite ones on A; or forces, as means over a time.
struct JointReaction {
    Vec3 force = Vec3::Zero();   // N s
    Vec3 torque = Vec3::Zero();  // N m s, about the anchor
    Vec3 moment =
        Vec3::Zero();  // N m s, of both about the origin of the bodies' coordinates, at the positions of each step

    void add(const JointReaction& other, double factor = 1.0) {
        force += factor * other.force;
        torque += factor * other.torque;
        moment += factor * other.moment;
    }
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [force, torque, moment] = self;
        archive.keep(force, torque, moment);
    }
};

struct JointAccount {
    /// Account of a step, or of a frame.
    struct Span {
        JointReaction reaction;
        double work_a = 0.0, work_b = 0.0;  // J, of the joint on each body
        JointWork work;
        int solves = 0;  // steps, or substeps
        // Second joint of a gear: the same, while the above are of the first joint.
        JointReaction second_reaction;
        double second_work_a = 0.0, second_work_b = 0.0;

        void add(const Span& other) {
            reaction.add(other.reaction);
            work_a += other.work_a;
            work_b += other.work_b;
            second_reaction.add(other.second_reaction);
            second_work_a += other.second_work_a;
            second_work_b += other.second_work_b;
            work.add(other.work);
            solves += other.solves;
        }
        /// Adds the reaction and the work of a flight in joint coordinates. Locks do no work there.
        void add_flight(const JointReaction& given, double on_a, double on_b) {
            reaction.add(given);
            work_a += on_a;
            work_b += on_b;
            ++solves;
        }
    };
    /// A flight, or a solve, between events.
    void take_flight(const Span& span) {
        const int solves = events.solves + 1;
        events.add(span);
        events.solves = solves;
        holds = true;
    }

    Span step, frame;
    Span events;           // of impacts, and flights between them, in this step: apart from the solve
    JointReaction mean;    // N and N m, over the last frame
    JointReaction second;  // N and N m, of a gear on its second joint: mean over the last step
    JointWork work;        // since the start
    bool holds = false;    // has held its bodies: the work of its locks is then no impact

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [step, frame, events, mean, second, work, holds] = self;
        archive.scratch(step, frame, events);
        archive.keep(mean, second, work, holds);
    }
};

/// Energies of all joints, J; all but the first since the start.
struct JointEnergies {
    double elastic = 0.0;   // in springs
    double motors = 0.0;    // work of motors
    double carriers = 0.0;  // work of kinematic bodies through joints
    double heat = 0.0;      // lost by friction, by dampers and by breaking
    double impacts = 0.0;   // lost at limits and by joints that catch their bodies
};

}  // namespace tumble
