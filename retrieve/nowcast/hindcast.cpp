#include "retrieve/nowcast/hindcast.h"

#include <algorithm>
#include <cmath>

#include "grid/mosaic/echo_image.h"

namespace stormcellar::retrieve {
namespace {

constexpr double tolerated_minutes = 2.5;
constexpr float least_echo_dbz = 5;

// Returns the maximum of each column, in dBZ above 0.
grid::EchoImage map_of(const grid::BrickView& view) {
    constexpr double lowest_m = -1000;  // all levels
    return grid::echo_image(view, {1, 0, lowest_m});
}

struct CsiTally {
    std::size_t both = 0, either = 0;

    [[nodiscard]] std::optional<double> csi() const {
        if (either == 0) return std::nullopt;
        return static_cast<double>(both) / static_cast<double>(either);
    }
};

struct ForecastTally {
    double absolute_db = 0;  // sum
    std::array<CsiTally, csi_thresholds_dbz.size()> csi;

    void add(float forecast_dbz, float observed_dbz) {
        absolute_db += static_cast<double>(std::abs(forecast_dbz - observed_dbz));
        for (std::size_t i = 0; i < csi.size(); ++i) {
            const auto threshold = static_cast<float>(csi_thresholds_dbz[i]);
            const bool a = forecast_dbz >= threshold, b = observed_dbz >= threshold;
            csi[i].both += a && b ? 1 : 0;
            csi[i].either += a || b ? 1 : 0;
        }
    }
    [[nodiscard]] ForecastScore score(std::size_t columns) const {
        ForecastScore score;
        score.mean_absolute_db = absolute_db / static_cast<double>(columns);
        for (std::size_t i = 0; i < csi.size(); ++i)
            score.csi[i] = csi[i].csi();
        return score;
    }
};

struct LeadTally {
    int hindcasts = 0;
    double minutes = 0;       // sum over the hindcasts
    std::size_t columns = 0;  // with echo
    ForecastTally nowcast, persistence;

    void add(const grid::EchoImage& moved, const grid::EchoImage& latest,
             const grid::EchoImage& observed, double lead_minutes) {
        ++hindcasts;
        minutes += lead_minutes;
        for (std::size_t i = 0; i < observed.seen.size(); ++i) {
            if (moved.seen[i] == 0 || latest.seen[i] == 0 || observed.seen[i] == 0) continue;
            const float a = moved.echo_db[i], b = latest.echo_db[i], truth = observed.echo_db[i];
            if (std::max({a, b, truth}) < least_echo_dbz) continue;
            ++columns;
            nowcast.add(a, truth);
            persistence.add(b, truth);
        }
    }
    [[nodiscard]] LeadScore score(double lead_minutes) const {
        LeadScore score;
        score.minutes = lead_minutes;
        if (columns == 0) return score;
        score.hindcasts = hindcasts;
        score.mean_lead_minutes = minutes / hindcasts;
        score.nowcast = nowcast.score(columns);
        score.persistence = persistence.score(columns);
        return score;
    }
};

// Returns the index of the lead for which a hindcast counts, or none.
std::optional<std::size_t> lead_of(double minutes, std::span<const double> leads_minutes) {
    std::optional<std::size_t> nearest;
    double least = tolerated_minutes;
    for (std::size_t i = 0; i < leads_minutes.size(); ++i) {
        const double apart = std::abs(minutes - leads_minutes[i]);
        if (apart > least) continue;
        least = apart;
        nearest = i;
    }
    return nearest;
}

}  // namespace

Result<std::vector<LeadScore>> score_hindcasts(
    std::span<const TimedGrid> grids, std::span<const std::optional<grid::MotionField>> pairs,
    std::span<const double> leads_minutes, int threads) {
    std::vector<grid::EchoImage> maps;
    for (const TimedGrid& grid : grids)
        maps.push_back(map_of(grid.view));
    std::vector<LeadTally> tallies(leads_minutes.size());
    for (std::size_t from = 1; from + 1 < grids.size(); ++from) {
        if (!latest_motion(pairs.first(from), *grids[from].view.spec)) continue;
        for (std::size_t to = from + 1; to < grids.size(); ++to) {
            const double minutes = seconds_between(grids[from].time, grids[to].time) / 60;
            const auto lead = lead_of(minutes, leads_minutes);
            if (minutes > longest_lead_minutes || !lead) continue;
            const auto moved = nowcast(grids[from].view, pairs.first(from), minutes, threads);
            if (!moved) return pass_on(moved);
            tallies[*lead].add(map_of(moved->view()), maps[from], maps[to], minutes);
        }
    }
    std::vector<LeadScore> scores;
    for (std::size_t i = 0; i < tallies.size(); ++i)
        scores.push_back(tallies[i].score(leads_minutes[i]));
    return scores;
}

std::string score_text(const LeadScore& score) {
    if (score.hindcasts == 0) return "error unknown, too few volumes to measure it";
    std::string text = fmt::format("measured on {} {}: ", score.hindcasts,
                                   score.hindcasts == 1 ? "hindcast" : "hindcasts");
    for (std::size_t i = csi_thresholds_dbz.size(); i-- > 0;) {
        const auto &ours = score.nowcast.csi[i], &still = score.persistence.csi[i];
        if (!ours || !still) continue;
        return text + fmt::format("CSI({} dBZ) {:.2f}, persistence {:.2f}", csi_thresholds_dbz[i],
                                  *ours, *still);
    }
    return text + fmt::format("mean error {:.1f} dB, persistence {:.1f} dB",
                              score.nowcast.mean_absolute_db, score.persistence.mean_absolute_db);
}

}  // namespace stormcellar::retrieve
