// level2/decode/record_plan.h -- finds the LDM records of the selected cuts from the VCP, so that
// other records are skipped.
//
// The pattern of the volume (message 5 in the first record) gives the cuts and the number of
// radials of each, and a record holds up to 120 radials of one cut. So the place of each cut's
// records is known before they are decompressed. The decoded records must agree with the plan: the
// first and the last record of each cut by the status of their radials, and also the records on
// either side of a wanted cut. If they do not agree (lost, repeated or longer records, restarted
// cuts, several volumes, metadata besides decoded radials), the plan is void.
//
// Limits    The content of a skipped record is not seen. If it held metadata, a message 5 would
//           give later sweeps another vcp_elevation_deg, and a message 2 would give the report
//           another status; but the RDA sends the pattern in the first record only. If as many
//           records of the skipped cuts came twice as were lost, the skipped cuts may differ from
//           the plan; sweeps_left_out is the plan's number.
// Memory    As many records as the pattern has, some hundreds.
// Threads   next() and agrees() may be called by different threads, each by one at a time.
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
    // Makes a plan. Returns none if the pattern is not known, if there is anything other than
    // records, or if there are more records than the pattern has. `bytes`, which begin after the
    // 24-byte header, must outlive the plan.
    [[nodiscard]] static std::optional<RecordPlan> make(std::span<const std::byte> bytes,
                                                        const Selection& selection);

    // Returns the records to decode, in order.
    [[nodiscard]] std::optional<LdmPart> next();
    // Returns true if the fragment of the next record, in the same order, agrees with the plan.
    [[nodiscard]] bool agrees(const Fragment& fragment);
    // Adds the skipped sweeps and records to the report.
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
