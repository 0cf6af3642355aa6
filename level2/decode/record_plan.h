// level2/decode/record_plan.h -- finds the LDM records of the selected cuts by the VCP, so that the
// decoder can skip the others.
//
// The pattern of the volume (message 5 in the first record) gives the cuts and the number of
// radials of each, and a record holds up to 120 radials of one cut. So the plan knows the records
// of each cut before they are decompressed. The decoded records must agree with the plan in
// elevation number, and the first and the last record of a cut also in the status of their radials.
// The records on either side of a wanted cut are decoded too, for this check. If a record does not
// agree (lost, repeated or longer records, restarted cuts, several volumes, metadata beside decoded
// radials), the plan is void.
//
// Limits    Skipped records are not read. Metadata in a skipped record would change
//           vcp_elevation_deg of later sweeps (message 5) or the status in the report (message 2);
//           but the RDA sends metadata in the first record only. If as many skipped records are
//           repeated as are lost, the plan does not notice. DecodeReport::sweeps_left_out is the
//           number from the plan.
// Memory    As many records as the pattern has, some hundreds.
// Threads   One thread at a time may call next(), and one thread at a time may call agrees(). These
//           may be two different threads.
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
    // Makes a plan. Returns none if the first record does not give the pattern, if the file has
    // damaged records or parts other than records, or if it has only one record or more records
    // than the pattern. `bytes`, which begin after the 24-byte header, must outlive the plan.
    [[nodiscard]] static std::optional<RecordPlan> make(std::span<const std::byte> bytes,
                                                        const Selection& selection);

    // Returns the next record to decode, in the order of the file, or none after the last one.
    [[nodiscard]] std::optional<LdmPart> next();
    // Returns true if `fragment` agrees with the plan. The fragments must come in the order of
    // next().
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
