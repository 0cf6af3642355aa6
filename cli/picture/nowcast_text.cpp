#include "cli/picture/nowcast_text.h"

#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "cli/shared/commands.h"

namespace stormcellar::cli {
namespace {

using nlohmann::ordered_json;
using retrieve::ForecastScore;
using retrieve::LeadScore;

std::string csi_text(const std::optional<double>& csi) {
    return csi ? fmt::format("{:.2f}", *csi) : "-";
}

ordered_json forecast_json(const ForecastScore& score) {
    ordered_json json = {{"mean_absolute_db", score.mean_absolute_db}};
    for (std::size_t i = 0; i < score.csi.size(); ++i) {
        const auto& csi = score.csi[i];
        json[fmt::format("csi_{}_dbz", retrieve::csi_thresholds_dbz[i])] =
            csi ? ordered_json(*csi) : ordered_json(nullptr);
    }
    return json;
}

std::string row_of(const LeadScore& score) {
    if (score.hindcasts == 0) {
        return fmt::format("{:>5.3g} {:>10}  error unknown\n", score.minutes, 0);
    }
    std::string row =
        fmt::format("{:>5.3g} {:>10} {:>8.2f} {:>8.2f}", score.minutes, score.hindcasts,
                    score.nowcast.mean_absolute_db, score.persistence.mean_absolute_db);
    for (std::size_t i = 0; i < score.nowcast.csi.size(); ++i) {
        row += fmt::format(" {:>8} {:>8}", csi_text(score.nowcast.csi[i]),
                           csi_text(score.persistence.csi[i]));
    }
    return row + "\n";
}

}  // namespace

std::string nowcast_table(const NowcastReport& report) {
    std::string text = fmt::format(
        "{}  {} grids, the latest of {}; echo moves toward {:.0f} degrees at {:.1f} m/s\n\n",
        report.domain, report.volumes, format_utc(report.latest), report.toward_deg,
        report.speed_mps);
    text += fmt::format("{:>5} {:>10} {:>17}", "lead", "hindcasts", "mean error");
    for (const int threshold : retrieve::csi_thresholds_dbz)
        text += fmt::format(" {:>17}", fmt::format("CSI({} dBZ)", threshold));
    text += fmt::format("\n{:>5} {:>10} {:>8} {:>8}", "min", "", "nowcast", "persist.");
    for (std::size_t i = 0; i < retrieve::csi_thresholds_dbz.size(); ++i)
        text += fmt::format(" {:>8} {:>8}", "nowcast", "persist.");
    text += "\n";
    for (const LeadScore& score : report.scores)
        text += row_of(score);
    for (const std::string& file : report.written)
        text += fmt::format("{}: written\n", printable(file));
    return text;
}

ordered_json nowcast_json(const NowcastReport& report) {
    ordered_json json = {{"domain", report.domain},       {"latest", format_utc(report.latest)},
                         {"grids", report.volumes},       {"method", "advection"},
                         {"speed_mps", report.speed_mps}, {"toward_deg", report.toward_deg},
                         {"leads", ordered_json::array()}};
    for (std::size_t i = 0; i < report.scores.size(); ++i) {
        const LeadScore& score = report.scores[i];
        ordered_json lead = {
            {"minutes", score.minutes},
            {"time", format_utc(report.latest +
                                std::chrono::milliseconds(std::llround(score.minutes * 60'000)))},
            {"hindcasts", score.hindcasts}};
        if (score.hindcasts > 0) {
            lead["mean_lead_minutes"] = score.mean_lead_minutes;
            lead["nowcast"] = forecast_json(score.nowcast);
            lead["persistence"] = forecast_json(score.persistence);
        }
        if (i < report.written.size()) lead["file"] = report.written[i];
        json["leads"].push_back(std::move(lead));
    }
    return json;
}

}  // namespace stormcellar::cli
