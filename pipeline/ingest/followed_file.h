// pipeline/ingest/followed_file.h -- a file whose volume is still growing, decoded once.
//
// Each call of read_to() reads and decodes what was appended since the last call. Complete sweeps
// are kept on disk, on a shelf (pipeline/keep/sweep_shelf.h), so that they take little memory.
// finish() returns the same volume, bit for bit, as decoding the whole file for the selected
// moments; it reads the file once more, to verify that the bytes have not changed. Only files of
// LDM records are followed, because other files must be held whole until their end anyway. After
// any error, the file must be read as a whole. Inside the pipeline room only. Thread contract: one
// thread at a time.
#pragma once

#include <bitset>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/checksum.h"
#include "pipeline/ingest/growing_set.h"
#include "pipeline/keep/derived_sweeps.h"
#include "pipeline/keep/sweep_shelf.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/growing_volume.h"

namespace stormcellar::pipeline {

using MomentSet = std::bitset<level2::moment_count>;
// Returns the given moments that the sweep has.
[[nodiscard]] MomentSet moments_in(const level2::Sweep& sweep,
                                   const std::vector<level2::Moment>& moments);

// Sweeps whose mean elevations differ by less are of one elevation.
inline constexpr double same_elevation_deg = 0.2;

// The sweeps of a volume, on a shelf on disk. Once the volume has ended, they no longer change.
struct ShelvedVolume {
    level2::Volume facts;  // without sweeps
    std::string source_file;
    std::unique_ptr<SweepShelf> shelf;
    // Identifies a sweep of this volume. Keys rise in the order of the sweeps. In a growing file,
    // the key is the index of the sweep in the volume. In a volume in chunks, it is the number of
    // the cut, because a late chunk may change the index of a sweep, but never its cut.
    using SweepKey = std::size_t;
    std::map<SweepKey, SweepShelf::Place> places;  // where each sweep is on the shelf
    struct Kept {
        // Describes a sweep of which these moments are gridded.
        Kept(const level2::Sweep& sweep, const std::vector<level2::Moment>& gridded);
        MomentSet moments;         // those of the gridded moments that the sweep has
        MomentSet measured;        // all moments that the sweep has
        double elevation_deg = 0;  // mean of its radials
    };
    std::map<SweepKey, Kept> sweeps;
    // The dealiased velocities of these sweeps. They were made for a living grid or for the final
    // grid.
    mutable DerivedSweeps dealiased;
    // For living grids: the gridded moments of these sweeps, without echo that is probably not
    // weather.
    mutable DerivedSweeps weather;

    // Keeps the VELD of the sweep with this key, if it is the sweep on the shelf.
    void keep_dealiased(SweepKey key, const level2::Sweep& sweep);
    // Returns true if no sweep with a gridded moment is lower than `elevation_deg`. This holds for
    // the lowest cut and its repetitions.
    [[nodiscard]] bool is_lowest(double elevation_deg) const;
};

// The sweeps that no living grid shows yet. (A living grid is the grid of a growing volume.)
struct UnshownSweeps {
    bool any = false, low = false;
    MomentSet moments;  // moments of these sweeps

    void add(MomentSet of_sweep, bool is_low) {
        any = true;
        low = low || is_low;
        moments |= of_sweep;
    }
};

class FollowedFile {
  public:
    struct Options {
        level2::Selection selection;
        std::vector<level2::Moment> moments = {level2::Moment::ref};  // of living grids
        std::string fallback_station;
        std::filesystem::path scratch;
        std::filesystem::path beneath = {};  // all files must be below it (IngestOptions)
        std::chrono::seconds chunk_timeout{600}, chunk_grace{30};  // see LivingGrids
        // Limit of the bytes of an incomplete sweep; 0: see stormcellar/level2/decode.h.
        std::uint64_t open_sweep_limit_bytes = 0;
    };

    // The facts that are known when a file begins to be followed.
    struct Growing {
        std::string station;            // station in its header; empty if it names none
        std::uint64_t last_record = 0;  // start of the last record; 0 if the file ends within it
    };
    // Examines a file by the lengths of its records. Returns the start of a growing file: a file of
    // LDM records whose last record has not come. Returns none for any other file, or if the file
    // cannot be read.
    [[nodiscard]] static std::optional<Growing> growing(const std::filesystem::path& path,
                                                        const std::filesystem::path& beneath = {});
    // Returns true if the last record of a growing file holds the last radial of a volume. The
    // record's control word does not matter.
    [[nodiscard]] static bool has_ended(const std::filesystem::path& path, const Growing& growing,
                                        const std::filesystem::path& beneath = {});
    static Result<std::unique_ptr<FollowedFile>> begin(const std::filesystem::path& path,
                                                       const Options& options);

    // Reads and decodes up to `size_bytes`. Calls `may_read_on` after each stretch; if that returns
    // false, reading ends with over_budget. Errors: also not_found if the file is gone.
    [[nodiscard]] Status read_to(std::uint64_t size_bytes,
                                 const std::function<bool()>& may_read_on = {});
    // Returns true if no read has failed.
    [[nodiscard]] bool is_whole() const { return is_whole_; }
    // Returns true if the volume's last radial has come.
    [[nodiscard]] bool has_ended() const { return growing_.has_last_radial(); }
    [[nodiscard]] UnshownSweeps news() const { return news_; }
    void set_shown() { news_ = {}; }
    // Returns the complete sweeps, with the station, pattern and position of the volume.
    [[nodiscard]] const ShelvedVolume& kept() const { return *kept_; }
    [[nodiscard]] std::size_t radials() const { return radials_; }
    [[nodiscard]] std::optional<UtcTime> newest() const { return newest_; }
    [[nodiscard]] bool holds_several() const { return growing_.holds_several(); }
    [[nodiscard]] std::uint64_t content_hash() const { return hash_.value(); }
    // Returns the approximate size of the file in memory and on the shelf.
    [[nodiscard]] Growth growth() const {
        return {growing_.held_bytes(), kept_->shelf->bytes(), !kept_->places.empty()};
    }

    [[nodiscard]] Result<level2::Decoded> finish();
    // Keeps the VELD of `dealiased`, the complete volume that finish() returned, with the sweeps.
    void keep_dealiased(const level2::Volume& dealiased);
    // Returns the sweeps, to keep them for the site's next volume. Call it after finish().
    [[nodiscard]] std::shared_ptr<const ShelvedVolume> take_kept() { return std::move(kept_); }

  private:
    FollowedFile(std::filesystem::path path, const Options& options);
    Status read_on(std::uint64_t size_bytes, const std::function<bool()>& may_read_on);
    Status take(std::span<const std::byte> bytes);
    Status shelve_new_sweeps();
    Status is_as_followed() const;

    std::filesystem::path path_, beneath_;
    std::vector<level2::Moment> moments_;
    level2::GrowingVolume growing_;
    std::unique_ptr<ShelvedVolume> kept_;
    std::size_t dropped_ = 0;  // sweeps with a lower index are only on the shelf
    Xxh3Stream hash_;
    std::uint64_t inode_ = 0, read_bytes_ = 0;
    std::size_t radials_ = 0;
    std::map<std::size_t, std::size_t> radials_of_;
    std::optional<UtcTime> newest_;
    UnshownSweeps news_;
    bool is_whole_ = true;
};

}  // namespace stormcellar::pipeline
