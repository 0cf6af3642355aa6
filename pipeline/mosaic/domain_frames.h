// pipeline/mosaic/domain_frames.h -- tells which frames a domain has, by which rules they are made,
// and which of them are current or missing.
//
// Threads   Functions without state; some of them read the store.
// Errors    not_found for a frame of a domain that is not in `domains`; those of reading the store.
#pragma once

#include <chrono>
#include <span>
#include <string_view>
#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// Returns the domain of this name if it has the moment, else null. No domain has the name of a
// partial.
[[nodiscard]] const Domain* find_domain(std::span<const Domain> domains, std::string_view name,
                                        level2::Moment moment);

// Returns the domain that has this frame.
[[nodiscard]] Result<const Domain*> domain_of(std::span<const Domain> domains,
                                              const cache::GridName& frame);

// Returns the options with which a domain's frames are made.
[[nodiscard]] FrameOptions frame_options(const Domain& domain, level2::Moment moment, int threads);

// Returns the instants from the first to the last, both included. They are whole multiples of the
// interval since midnight UTC.
[[nodiscard]] std::vector<UtcTime> instants_between(UtcTime from, UtcTime to,
                                                    std::chrono::seconds interval);

// Returns true if the instant is between the middles of partials: some partial's middle is not
// after it, and some partial's middle is not before it.
[[nodiscard]] bool lies_between(const std::vector<PartialView>& partials, UtcTime instant);

// A frame uses only partials whose middle is at most this far from the frame's instant.
inline constexpr std::chrono::milliseconds greatest_frame_gap = FrameOptions{}.greatest_gap;

enum class FrameStanding {
    not_due,  // no partials are near the instant on both sides of it
    current,  // exists, and its partials and the rules have not changed since
    to_make,  // is missing, is damaged, or differs from what the partials give now
};

// Compares the frame in the store with the frame that MosaicMaker::make_again() would make. Reads
// no cells.
[[nodiscard]] Result<FrameStanding> standing_of(const cache::StoreReader& store,
                                                std::span<const Domain> domains,
                                                const cache::GridName& frame);

// Returns the frames that are due but do not exist, newest first. The search begins `newest` before
// the start of the newest volume, but not before the oldest existing frame.
[[nodiscard]] Result<std::vector<cache::GridName>> missing_frames(const cache::StoreReader& store,
                                                                  std::span<const Domain> domains,
                                                                  std::chrono::milliseconds newest);

}  // namespace stormcellar::pipeline
