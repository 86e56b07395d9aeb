#include "core/check.h"
#include "page/clip_data.h"

#include <zlib.h>

#include <span>

namespace tumble {
namespace {

std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
    constexpr int raw = -15, memory = 9;  // no header; the most memory, for the best compression
    z_stream stream{};
    TUMBLE_CHECK_EQ(deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, raw, memory, Z_DEFAULT_STRATEGY), Z_OK);
    std::vector<std::byte> room(deflateBound(&stream, uLong(bytes.size())));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(room.data());
    stream.avail_out = uInt(room.size());
    const int result = deflate(&stream, Z_FINISH);
    room.resize(stream.total_out);
    deflateEnd(&stream);
    TUMBLE_CHECK_EQ(result, Z_STREAM_END);
    return room;
}

}  // namespace

ClipData make_clip_data(const PageClip& clip) {
    ClipData data = make_clip_container(clip);
    data.bytes = deflated(data.bytes);
    return data;
}

}  // namespace tumble
