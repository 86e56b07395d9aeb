#include "output/matroska_stream.h"

#include <bit>
#include <string_view>

namespace tumble {
namespace {

using Bytes = std::vector<std::byte>;

// Element numbers and names of RFC 9559.
enum Element : std::uint32_t {
    ebml = 0x1a45dfa3,
    doc_type = 0x4282,
    doc_type_version = 0x4287,
    doc_type_read_version = 0x4285,
    segment = 0x18538067,
    info = 0x1549a966,
    timestamp_scale = 0x2ad7b1,
    muxing_app = 0x4d80,
    writing_app = 0x5741,
    tracks = 0x1654ae6b,
    track_entry = 0xae,
    track_number = 0xd7,
    track_uid = 0x73c5,
    track_type = 0x83,
    flag_lacing = 0x9c,
    default_duration = 0x23e383,
    codec_id = 0x86,
    video = 0xe0,
    pixel_width = 0xb0,
    pixel_height = 0xba,
    uncompressed_four_cc = 0x2eb524,
    cluster = 0x1f43b675,
    timestamp = 0xe7,
    simple_block = 0xa3,
};

// ns: the error of a time stamp is below half a nanosecond and does not accumulate
constexpr std::int64_t one_second = 1'000'000'000;
constexpr std::uint64_t unknown_size = (std::uint64_t(1) << 56) - 1;
constexpr std::byte only_track{0x81};  // track 1, as a number of variable length
constexpr std::byte key_frame{0x80};

/// Names of pixel forms that ffmpeg knows.
std::string_view four_cc(PixelFormat form) {
    using namespace std::string_view_literals;
    switch (form) {
        case PixelFormat::yuv420:
            return "I420"sv;
        case PixelFormat::yuva420:
            return "Y4\x0b\x08"sv;
        case PixelFormat::rgba:
            return "RGBA"sv;
    }
    return {};
}

/// A big-endian number of `bytes` bytes.
void append(Bytes& to, std::uint64_t value, int bytes) {
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) to.push_back(std::byte((value >> shift) & 0xff));
}

void append_head(Bytes& to, Element element, std::uint64_t size) {
    append(to, element, (std::bit_width(std::uint32_t(element)) + 7) / 8);
    append(to, size | std::uint64_t(1) << 56, 8);  // sizes have eight bytes, marked by the first bit
}

void append(Bytes& to, Element element, const Bytes& content) {
    append_head(to, element, content.size());
    to.insert(to.end(), content.begin(), content.end());
}

void append(Bytes& to, Element element, std::string_view text) {
    append_head(to, element, text.size());
    for (const char c : text) to.push_back(std::byte(c));
}

void append_number(Bytes& to, Element element, std::uint64_t number) {
    append_head(to, element, 8);
    append(to, number, 8);
}

/// n / rate in ns, rounded. In two parts: n * denominator * 1e9 would not fit into 64 bits.
std::int64_t nanoseconds(std::int64_t n, const FrameRate& rate) {
    const std::int64_t ticks = n * rate.denominator;
    return ticks / rate.numerator * one_second +
           (ticks % rate.numerator * one_second + rate.numerator / 2) / rate.numerator;
}

}  // namespace

Bytes matroska_head(PixelFormat form, int width, int height, const FrameRate& rate) {
    Bytes type, about, picture, track, entries, head;
    append(type, doc_type, "matroska");
    append_number(type, doc_type_version, 4);
    append_number(type, doc_type_read_version, 2);

    append_number(about, timestamp_scale, 1);  // ns
    append(about, muxing_app, "tumble");
    append(about, writing_app, "tumble");

    append_number(picture, pixel_width, static_cast<std::uint64_t>(width));
    append_number(picture, pixel_height, static_cast<std::uint64_t>(height));
    append(picture, uncompressed_four_cc, four_cc(form));

    append_number(track, track_number, 1);
    append_number(track, track_uid, 1);
    append_number(track, track_type, 1);  // video
    append_number(track, flag_lacing, 0);
    append_number(track, default_duration, static_cast<std::uint64_t>(nanoseconds(1, rate)));
    append(track, codec_id, "V_UNCOMPRESSED");
    append(track, video, picture);
    append(entries, track_entry, track);

    append(head, ebml, type);
    append_head(head, segment, unknown_size);
    append(head, info, about);
    append(head, tracks, entries);
    return head;
}

Bytes matroska_frame_head(std::int64_t n, const FrameRate& rate, std::size_t bytes) {
    Bytes inside;
    append_number(inside, timestamp, static_cast<std::uint64_t>(nanoseconds(n, rate)));
    append_head(inside, simple_block, bytes + 4);
    inside.push_back(only_track);
    append(inside, 0, 2);  // relative to the cluster's time
    inside.push_back(key_frame);
    Bytes head;
    append_head(head, cluster, inside.size() + bytes);
    head.insert(head.end(), inside.begin(), inside.end());
    return head;
}

}  // namespace tumble
