#include "overlay/overlay_frame.h"

#include "core/check.h"

#include <cstring>
#include <type_traits>

namespace tumble {
namespace {

// One function lists the members for both directions, so that they cannot disagree.
class Writer {
public:
    explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}
    void raw(const void* from, std::size_t size) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + size);
        std::memcpy(bytes_.data() + at, from, size);
    }
    template <class T>
    void number(const T& value) {
        raw(&value, sizeof value);
    }
    std::size_t count(std::size_t n) {
        number(n);
        return n;
    }

private:
    std::vector<std::byte>& bytes_;
};

class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    void raw(void* to, std::size_t size) {
        TUMBLE_CHECK_LE(size, bytes_.size());
        std::memcpy(to, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }
    template <class T>
    void number(T& value) {
        raw(&value, sizeof value);
    }
    std::size_t count(std::size_t) {
        std::size_t n = 0;
        number(n);
        return n;
    }

private:
    std::span<const std::byte> bytes_;
};

template <class Stream, class V>
void vector(Stream& s, V& v) {
    for (int i = 0; i < 3; ++i) s.number(v[i]);
}

template <class Stream, class Paint>
void paint(Stream& s, Paint& p) {
    s.number(p.color.r);
    s.number(p.color.g);
    s.number(p.color.b);
    s.number(p.opacity);
    s.number(p.depth_tested);
    s.number(p.allowance);
}

template <class Stream, class List, class Each>
void list(Stream& s, List& items, const Each& each) {
    const std::size_t n = s.count(items.size());
    if constexpr (!std::is_const_v<List>) items.resize(n);
    for (auto& item : items) each(item);
}

template <class Stream, class Number>
void number_or_none(Stream& s, Number& number) {
    const bool given = s.count(number.has_value() ? 1 : 0) != 0;
    if constexpr (!std::is_const_v<Number>)
        if (given) number.emplace();
    if (given) s.number(*number);
}

template <class Stream, class Frame>
void members(Stream& s, Frame& frame) {
    list(s, frame.surfaces, [&](auto& surface) {
        s.number(surface.body);
        vector(s, surface.origin);
        for (int i = 0; i < 4; ++i) s.number(surface.orientation.coeffs()[i]);
        paint(s, surface.paint);
        s.number(surface.shaded);
    });
    list(s, frame.lines, [&](auto& line) {
        list(s, line.points, [&](auto& point) { vector(s, point); });
        paint(s, line.paint);
        s.number(line.width);
    });
    list(s, frame.arrows, [&](auto& arrow) {
        vector(s, arrow.from);
        vector(s, arrow.to);
        paint(s, arrow.paint);
        s.number(arrow.width);
        s.number(arrow.double_head);
    });
    list(s, frame.markers, [&](auto& marker) {
        vector(s, marker.at);
        paint(s, marker.paint);
        s.number(marker.shape);
        s.number(marker.radius);
    });
    list(s, frame.labels, [&](auto& label) {
        vector(s, label.at);
        paint(s, label.paint);
        list(s, label.text, [&](auto& letter) { s.number(letter); });
        s.number(label.size);
    });
    list(s, frame.callouts, [&](auto& callout) {
        vector(s, callout.of);
        vector(s, callout.at);
        s.number(callout.lift);
        list(s, callout.text, [&](auto& letter) { s.number(letter); });
        s.number(callout.size);
        s.number(callout.color.r);
        s.number(callout.color.g);
        s.number(callout.color.b);
        s.number(callout.leader);
    });
    s.number(frame.legend);
    number_or_none(s, frame.damage);
}

}  // namespace

void write_bytes(const OverlayFrame& frame, std::vector<std::byte>& bytes) {
    bytes.clear();
    Writer writer(bytes);
    members(writer, frame);
}

void read_bytes(std::span<const std::byte> bytes, OverlayFrame& frame) {
    Reader reader(bytes);
    members(reader, frame);
}

}  // namespace tumble
