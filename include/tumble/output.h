// Files: PNG images, clips, tables. Each file is written aside and gets its name when it is whole. Errors are Error
// (run) with the path, unless a comment says otherwise. Every member of a writer throws Error (input) after finish(),
// after an Error (run), and where it was moved from.
#pragma once

#include "contacts.h"
#include "image.h"
#include "joints.h"
#include "scene.h"
#include "snapshot.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

TUMBLE_BEGIN

enum class PngAlpha { dropped, kept };

/// 8-bit RGB, or RGBA with `kept`: the same bytes as `tumble render --frames` writes, and with `kept` as with
/// `--transparent`. Throws Error (input) where the pixels do not fit the size.
void write_png(const std::string& file, const Image& image, PngAlpha alpha = PngAlpha::dropped);
/// Any PNG file as RGBA. Throws Error (input) where the file is missing or broken.
Image read_png(const std::string& file);

/// The four rules of `tumble compare` for images that are the same for the eye.
struct CompareOptions {
    int tolerance = 3;           // levels of 255, 0 to 255: a smaller difference of a channel does not count
    double fraction = 1e-4;      // of all pixels, 0 to 1: so many may differ by more
    std::optional<int> cluster;  // pixels, 0 to 64, of any 8 x 8 that may differ by more; 4 + 64 fraction if not given
    std::optional<double> window;  // levels, 0 to 255: mean difference of any 8 x 8; tolerance / 2 + 255 fraction
    std::optional<int> shade;  // pixels, 0 to 64, of any 8 x 8 that may be off by more than half the tolerance in one
                               // direction; as cluster
};

struct Comparison {
    bool alike = false;
    std::string reason;                 // the rules that do not hold, with figures; empty where alike
    std::int64_t differing_pixels = 0;  // any difference
    int max_difference = 0;             // levels of 255, largest over pixels and channels
    int max_column = 0, max_row = 0;    // its pixel, from the top left; the first of equal ones, row by row
};
/// Throws Error (input) where the sizes differ or an option is out of its range.
Comparison compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// The same for PNG and JPEG files of any size: a few rows of each are in memory. Writes an image of the differences
/// (red beyond the tolerance, blue within it; of two sizes yellow and green where only one has pixels) where that file
/// is named. Throws Error (input) also where an image is missing or broken.
Comparison compare_png_files(const std::string& a, const std::string& b, const CompareOptions& options = {},
                             const std::string& difference = {});

enum class ClipQuality { draft, normal, best };

struct ClipOptions {
    ClipQuality quality = ClipQuality::normal;
    bool variable_rate = false;  // true: an image that stays is stored once and shown longer
    bool transparent = false;    // true: the clip keeps alpha; .webm and .mov (ProRes 4444) alone can
};

/// Encodes a clip with the ffmpeg program, which is started by the constructor. The ending of the file chooses the
/// format: .mp4, .mov, .mkv, .webm, .gif. The file appears at finish(), or never.
class ClipWriter {
public:
    /// Throws Error (input) for an unknown ending, or a frame rate or alpha that the format cannot keep.
    ClipWriter(const std::string& file, const OutputSettings& output, const ClipOptions& options = {});
    ~ClipWriter();
    ClipWriter(ClipWriter&&) noexcept;
    ClipWriter& operator=(ClipWriter&&) noexcept;

    /// The next frame. Throws Error (input) for an image of another size than that of `output`, Error (run) with
    /// ffmpeg's message where it failed.
    void write(const Image& image);
    /// Waits for ffmpeg and checks that the clip holds every frame. Throws Error (input) without a frame, Error (run)
    /// where the clip is not whole.
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of `tumble simulate --trajectory`: one row per frame and body that is not fixed.
class TrajectoryTable {
public:
    /// Keeps the data of the scene alive.
    TrajectoryTable(const std::string& file, const Scene& scene);
    ~TrajectoryTable();
    TrajectoryTable(TrajectoryTable&&) noexcept;
    TrajectoryTable& operator=(TrajectoryTable&&) noexcept;

    /// Throws Error (input) where the snapshot does not hold each body of the scene.
    void add(const Snapshot& snapshot);
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of `tumble simulate --energy`: one row per frame.
class EnergyTable {
public:
    explicit EnergyTable(const std::string& file);
    /// With the columns of joints where the scene has some.
    EnergyTable(const std::string& file, const Scene& scene);
    ~EnergyTable();
    EnergyTable(EnergyTable&&) noexcept;
    EnergyTable& operator=(EnergyTable&&) noexcept;

    /// The energies of a frame at that time in s.
    void add(std::int64_t frame, double time, const Energies& energies);
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of `tumble simulate --impacts`: one row per impulse.
class ImpactTable {
public:
    /// `file` with the ending .npz: one array per column (see docs/reference/tables.md); otherwise CSV.
    ImpactTable(const std::string& file, const Scene& scene);
    ~ImpactTable();
    ImpactTable(ImpactTable&&) noexcept;
    ImpactTable& operator=(ImpactTable&&) noexcept;

    void add(const FrameContacts& contacts);
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of `tumble simulate --contacts`: one row per frame and contact point.
class ContactTable {
public:
    ContactTable(const std::string& file, const Scene& scene);
    ~ContactTable();
    ContactTable(ContactTable&&) noexcept;
    ContactTable& operator=(ContactTable&&) noexcept;

    void add(std::int64_t frame, double time, const FrameContacts& contacts);  // s
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of `tumble simulate --loads`: one row per frame and dynamic body.
class LoadTable {
public:
    LoadTable(const std::string& file, const Scene& scene);
    ~LoadTable();
    LoadTable(LoadTable&&) noexcept;
    LoadTable& operator=(LoadTable&&) noexcept;

    void add(std::int64_t frame, double time, const FrameContacts& contacts);  // s
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of `tumble simulate --breaks`: one row per bond that failed.
class BreakTable {
public:
    BreakTable(const std::string& file, const Scene& scene);
    ~BreakTable();
    BreakTable(BreakTable&&) noexcept;
    BreakTable& operator=(BreakTable&&) noexcept;

    void add(const std::vector<Break>& breaks);
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of `tumble simulate --joints`: one row per frame and joint.
class JointTable {
public:
    JointTable(const std::string& file, const Scene& scene);
    ~JointTable();
    JointTable(JointTable&&) noexcept;
    JointTable& operator=(JointTable&&) noexcept;

    /// Throws Error (input) where the states are not those of each joint of the scene.
    void add(std::int64_t frame, double time, const std::vector<JointState>& joints);  // s
    void finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

TUMBLE_END
