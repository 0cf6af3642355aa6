// pipeline/mosaic/domain_frames.h -- determines which frames a domain has, how they are made, and
// which are current or missing.
//
// Threads: pure functions of their arguments and of the store's contents.
// Errors: not_found for a frame of a domain that is not given; otherwise the store cannot be read.
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

// Returns the domain of this name (not that of a partial) if it has the moment; else null.
[[nodiscard]] const Domain* find_domain(std::span<const Domain> domains, std::string_view name,
                                        level2::Moment moment);

// Returns the domain that has this frame.
[[nodiscard]] Result<const Domain*> domain_of(std::span<const Domain> domains,
                                              const cache::GridName& frame);

// Returns the options with which a domain's frames are made.
[[nodiscard]] FrameOptions frame_options(const Domain& domain, level2::Moment moment, int threads);

// Returns the instants from the first to the last, both included: whole multiples of the interval
// since midnight UTC.
[[nodiscard]] std::vector<UtcTime> instants_between(UtcTime from, UtcTime to,
                                                    std::chrono::seconds interval);

// Returns true if the instant is between two partials, one of which counts for it by the rule of
// MosaicMaker::take_in().
[[nodiscard]] bool lies_between(const std::vector<PartialView>& partials, UtcTime instant);

// Volumes of a site that are farther apart make no frame between them.
inline constexpr std::chrono::milliseconds greatest_frame_gap = FrameOptions{}.greatest_gap;

enum class FrameStanding {
    not_due,  // no volume before the instant, or none after it, that is close enough
    current,  // exists, and was made of the present partials by the present rules
    to_make,  // is missing, damaged, or differs from what the present partials give
};

// Returns whether the frame is due, and whether it is what MosaicMaker::make_again() would make.
[[nodiscard]] Result<FrameStanding> standing_of(const cache::StoreReader& store,
                                                std::span<const Domain> domains,
                                                const cache::GridName& frame);

// Returns the frames that are due but do not exist, newest first. It looks between the partials of
// the newest volumes (back to `newest` before the last), but not before the oldest existing frame.
[[nodiscard]] Result<std::vector<cache::GridName>> missing_frames(const cache::StoreReader& store,
                                                                  std::span<const Domain> domains,
                                                                  std::chrono::milliseconds newest);

}  // namespace stormcellar::pipeline
