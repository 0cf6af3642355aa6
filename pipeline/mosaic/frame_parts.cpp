#include "pipeline/mosaic/frame_parts.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/checksum.h"

namespace stormcellar::pipeline {
namespace {

// Hashes values as they are in memory. This is enough, because only machines of one kind compare
// fingerprints.
class Digest {
  public:
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void add(Number number) {
        const auto bytes = std::as_bytes(std::span(&number, 1));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    void add(std::string_view text) {
        add(text.size());
        const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }
    void add(UtcTime time) { add(time.time_since_epoch().count()); }
    [[nodiscard]] std::uint64_t value() const {
        const std::uint64_t hash = xxh3_64(bytes_);
        return hash == 0 ? 1 : hash;
    }

  private:
    std::vector<std::byte> bytes_;
};

// Adds those facts of the cells that do not depend on how the grid's file is packed.
void add_bricks(const grid::BrickView& view, Digest& digest) {
    digest.add(view.quantization.code_bytes);
    digest.add(view.quantization.first_value);
    digest.add(view.quantization.step);
    for (const grid::BrickEntry& brick : view.bricks) {
        digest.add(static_cast<std::uint8_t>(brick.kind));
        if (brick.kind == grid::BrickKind::uniform) {
            digest.add(static_cast<std::uint8_t>(brick.uniform_status));
        } else {
            digest.add(brick.checksum);
        }
    }
}

void add_spec(const grid::GridSpec& spec, Digest& digest) {
    digest.add(static_cast<int>(spec.projection));
    for (const double number :
         {spec.center_latitude_deg, spec.center_longitude_deg, spec.spacing_m, spec.spacing_deg,
          spec.parallels_deg[0], spec.parallels_deg[1], spec.offset_x_cells, spec.offset_y_cells}) {
        digest.add(number);
    }
    digest.add(spec.nx);
    digest.add(spec.ny);
    for (const double level_m : spec.levels_m)
        digest.add(level_m);
}

std::vector<grid::FramePart> of_site(std::span<const grid::FramePart> parts,
                                     const std::string& icao) {
    std::vector<grid::FramePart> found;
    std::copy_if(parts.begin(), parts.end(), std::back_inserter(found),
                 [&](const grid::FramePart& part) { return part.icao == icao; });
    return found;
}

}  // namespace

std::uint64_t fingerprint_of(const PartialView& partial) {
    const cache::GridDescription& description = *partial.description;
    Digest digest;
    add_spec(description.spec, digest);
    digest.add(static_cast<int>(description.moment));
    digest.add(description.start_time);
    digest.add(description.end_time);
    const grid::SitePosition& site = partial.site();
    digest.add(site.icao);
    digest.add(site.latitude_deg);
    digest.add(site.longitude_deg);
    digest.add(site.altitude_m);
    for (const grid::SweepTime& sweep : description.provenance.sweeps) {
        digest.add(sweep.elevation_deg);
        digest.add(sweep.start);
        digest.add(sweep.first_azimuth_deg);
        digest.add(sweep.degrees_per_s);
    }
    add_bricks(partial.view, digest);
    return digest.value();
}

std::uint64_t recipe_of(const FrameOptions& options) {
    Digest digest;
    digest.add(static_cast<int>(options.overlap.moment));
    digest.add(grid::overlap_name(options.overlap.overlap));
    digest.add(static_cast<int>(options.overlap.averaging));
    digest.add(options.overlap.length_m);
    digest.add(grid::time_method_name(options.time));
    digest.add(static_cast<int>(options.sweep_times));
    return digest.value();
}

Result<std::vector<grid::FramePart>> parts_of(const grid::GridSpec& domain,
                                              std::span<const PartialView* const> partials) {
    std::vector<grid::FramePart> parts;
    for (const PartialView* partial : partials) {
        const cache::GridDescription& description = *partial->description;
        const auto window = grid::window_of(domain, description.spec);
        if (!window) {
            return fail(ErrorCode::bad_argument, "the grid of {} is not a window of the domain",
                        partial->site().icao);
        }
        parts.push_back(
            {partial->site().icao, description.time, fingerprint_of(*partial), *window});
    }
    return parts;
}

std::vector<grid::GridWindow> changed_windows(std::span<const grid::FramePart> before,
                                              std::span<const grid::FramePart> now) {
    std::set<std::string> sites;
    for (const auto parts : {before, now}) {
        for (const grid::FramePart& part : parts)
            sites.insert(part.icao);
    }
    std::vector<grid::GridWindow> changed;
    for (const std::string& icao : sites) {
        const auto old_parts = of_site(before, icao), new_parts = of_site(now, icao);
        if (old_parts == new_parts) continue;
        for (const auto& parts : {old_parts, new_parts}) {
            for (const grid::FramePart& part : parts)
                changed.push_back(part.window);
        }
    }
    return changed;
}

bool share_bricks(const grid::GridWindow& a, const grid::GridWindow& b) {
    const auto overlap = [](int first_a, int end_a, int first_b, int end_b) {
        return first_a / grid::brick_edge < grid::bricks_along(end_b) &&
               first_b / grid::brick_edge < grid::bricks_along(end_a);
    };
    return overlap(a.first_x, a.end_x(), b.first_x, b.end_x()) &&
           overlap(a.first_y, a.end_y(), b.first_y, b.end_y());
}

}  // namespace stormcellar::pipeline
