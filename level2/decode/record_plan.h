// level2/decode/record_plan.h -- which LDM records hold the cuts that are asked for, told from the
// VCP.
//
// The volume's pattern (message 5 in the first record) gives the cuts and how many radials each
// has, and a record holds up to 120 radials of one cut. So the place of each cut's records is known
// before they are decompressed, and those of other cuts are skipped. What is decoded must agree
// with the plan, the first and the last record of each cut by their radials' status, and so must
// the records on either side of a wanted cut. Where something does not agree (lost, repeated or
// longer records, restarted cuts, several volumes, metadata beside radials that are decoded), the
// plan is void. Limit   what is in a skipped record is not seen. Metadata there: a message 5 would
// give later
//         sweeps another vcp_elevation_deg, a message 2 the report another status; the RDA sends
//         the pattern in the first record only. And cuts that are not wanted may be others than the
//         plan has, where as many of their records came twice as were lost; sweeps_left_out is the
//         plan's.
// Memory  as many records as the pattern has, some hundreds.
// Thread contract: next() and agrees() from different threads, each from one at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "level2/containers/ldm_framer.h"
#include "stormcellar/level2/decode_report.h"
#include "stormcellar/level2/fragment.h"
#include "stormcellar/level2/selection.h"

namespace stormcellar::level2 {

class RecordPlan {
  public:
    // None where the pattern is not known, there is more than records, or more records than the
    // pattern has. `bytes` (behind the 24-byte header) must outlive the plan.
    [[nodiscard]] static std::optional<RecordPlan> make(std::span<const std::byte> bytes,
                                                        const Selection& selection);

    // The records to be decoded, in their order.
    [[nodiscard]] std::optional<LdmPart> next();
    // Whether the fragment of the next record, in the same order, is what the plan expects.
    [[nodiscard]] bool agrees(const Fragment& fragment);
    // Adds what was skipped.
    void report(DecodeReport& report) const;

  private:
    void want_witnesses();
    struct Record {
        LdmPart part;
        int cut = 0;  // 0: metadata
        bool first_of_cut = false;
        bool last_of_cut = false;
        bool wanted = true;
    };
    [[nodiscard]] static std::vector<Record> expected(const Vcp& pattern,
                                                      const Selection& selection);

    std::vector<Record> records_;
    std::size_t next_ = 0;
    std::size_t checked_ = 0;
};

}  // namespace stormcellar::level2
