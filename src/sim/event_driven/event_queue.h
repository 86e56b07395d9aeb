// Queue of each body's next event, the earliest on top: a binary heap with the position of every body, ordered by time
// and then by body, so that the order does not depend on its history.
#pragma once

#include "sim/event_driven/event_time.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace tumble {

class EventQueue {
public:
    explicit EventQueue(std::size_t bodies) : place_(bodies, none) {}

    bool empty() const { return heap_.empty(); }
    std::uint32_t first() const { return heap_[0].body; }
    const EventTime& first_moment() const { return heap_[0].moment; }

    void set(std::uint32_t body, const EventTime& moment) {
        if (place_[body] == none) {
            place_[body] = std::uint32_t(heap_.size());
            heap_.push_back({moment, body});
        } else {
            heap_[place_[body]].moment = moment;
        }
        sink(rise(place_[body]));
    }

    void remove(std::uint32_t body) {
        const std::uint32_t at = place_[body];
        if (at == none) return;
        place_[body] = none;
        const Entry last = heap_.back();
        heap_.pop_back();
        if (at == heap_.size()) return;
        put(at, last);
        sink(rise(at));
    }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [heap, place] = self;
        archive.within_bodies(heap);
        archive.scratch(place);  // follows from the heap
        if constexpr (!std::is_const_v<Self>) self.refill();
    }

private:
    static constexpr std::uint32_t none = UINT32_MAX;
    struct Entry {
        EventTime moment;
        std::uint32_t body;
        friend auto operator<=>(const Entry&, const Entry&) = default;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [moment, body] = self;
            archive.keep(moment);
            archive.body(body);
        }
    };

    /// Puts the entries in anew: a heap stays as it is.
    void refill() {
        const std::vector<Entry> entries = std::exchange(heap_, {});
        std::fill(place_.begin(), place_.end(), none);
        for (const Entry& entry : entries) set(entry.body, entry.moment);
    }
    void put(std::uint32_t at, const Entry& entry) {
        heap_[at] = entry;
        place_[entry.body] = at;
    }
    std::uint32_t rise(std::uint32_t at) {
        const Entry entry = heap_[at];
        while (at > 0 && entry < heap_[(at - 1) / 2]) {
            put(at, heap_[(at - 1) / 2]);
            at = (at - 1) / 2;
        }
        put(at, entry);
        return at;
    }
    void sink(std::uint32_t at) {
        const Entry entry = heap_[at];
        for (std::uint32_t child = 2 * at + 1; child < heap_.size(); child = 2 * at + 1) {
            if (child + 1 < heap_.size() && heap_[child + 1] < heap_[child]) ++child;
            if (!(heap_[child] < entry)) break;
            put(at, heap_[child]);
            at = child;
        }
        put(at, entry);
    }

    std::vector<Entry> heap_;
    std::vector<std::uint32_t> place_;
};

}  // namespace tumble
