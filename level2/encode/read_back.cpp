#include "level2/encode/read_back.h"

#include <utility>

#include "level2/containers/archive_header.h"
#include "level2/decode/array_room.h"
#include "level2/decode/fragment_builder.h"
#include "level2/decode/message_reader.h"
#include "level2/encode/encode_checks.h"
#include "stormcellar/level2/volume_difference.h"

namespace stormcellar::level2 {

Status ReadBack::read_header(std::span<const std::byte> bytes) {
    auto header = read_archive_header(bytes);
    if (!header) return refuse("its header's name is none that begins a volume");
    if (volume_.header) {
        builder_.set_header(std::move(*header));
    } else if (header->icao != volume_.station) {
        return refuse("the station '{}' is no ICAO identifier", volume_.station);
    }
    return {};
}

std::optional<ReadBack::Fault> ReadBack::read_record(std::span<const std::byte> messages) {
    const Selection everything;
    ArrayRoom room{builder_.arrays_left()};
    FragmentBuilder pieces{room, rows_of_a_record, everything};
    MessageReader reader{pieces};
    reader.read(messages, true);
    std::optional<Fragment> fragment = reader.take_fragment();
    if (!fragment) return Fault{0, "it has no end"};
    fragment->failure = reader.failure();
    fragment->output_bytes += messages.size();
    fragment->report.ldm_records = 1;
    const DecodeReport& report = fragment->report;
    if (!report.problems.empty()) {
        const Problem& problem = report.problems.front();
        return Fault{static_cast<std::size_t>(problem.offset.value_or(0)),
                     report.corruption ? report.corruption->reason : problem.message};
    }
    const Status taken = builder_.append(std::move(*fragment));
    return taken ? std::nullopt : std::optional{Fault{0, taken.error().message}};
}

Status ReadBack::finish() {
    const auto decoded = builder_.finish(volume_.station);
    if (!decoded) return refuse("{}", decoded.error().message);
    const std::string where = difference(volume_, decoded->volume);
    if (!where.empty()) return refuse("{} would not come back as it is", where);
    return {};
}

}  // namespace stormcellar::level2
