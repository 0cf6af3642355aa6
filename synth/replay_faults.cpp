#include "synth/replay_faults.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <string>
#include <utility>

#include "base/floating_point.h"
#include "base/split.h"
#include "synth/counter_random.h"

namespace stormcellar::synth {
namespace {

constexpr std::string_view example = "drop=0.01,repeat=0.01,reorder=0.02,truncate=0.005,seed=7";

template <class Number>
bool read_number(std::string_view text, Number& number) {
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    return problem == std::errc{} && end == text.data() + text.size();
}

Status set(FaultRates& rates, std::string_view key, std::string_view value) {
    const std::array<std::pair<std::string_view, double*>, 4> probabilities = {
        {{"drop", &rates.drop},
         {"repeat", &rates.repeat},
         {"reorder", &rates.reorder},
         {"truncate", &rates.truncate}}};
    for (const auto& [name, probability] : probabilities) {
        if (name != key) continue;
        // The second condition also refuses NaN.
        if (!read_number(value, *probability) || !is_within(*probability, 0.0, 1.0)) {
            return fail(ErrorCode::bad_argument,
                        "faults: {} must be a probability from 0 to 1, not '{}'", key, value);
        }
        return {};
    }
    if (key != "seed") {
        return fail(ErrorCode::bad_argument,
                    "faults: there is no fault '{}'; write, for example, {}", key, example);
    }
    if (!read_number(value, rates.seed)) {
        return fail(ErrorCode::bad_argument, "faults: seed must be a whole number, not '{}'",
                    value);
    }
    return {};
}

Fault fault_of(const FaultRates& rates, double random) {
    const std::array<std::pair<Fault, double>, 4> kinds = {{{Fault::drop, rates.drop},
                                                            {Fault::repeat, rates.repeat},
                                                            {Fault::reorder, rates.reorder},
                                                            {Fault::truncate, rates.truncate}}};
    for (const auto& [fault, probability] : kinds) {
        if (random < probability) return fault;
        random -= probability;
    }
    return Fault::none;
}

}  // namespace

std::string_view to_string(Fault fault) {
    static constexpr std::array<std::string_view, 5> names = {"none", "drop", "repeat", "reorder",
                                                              "truncate"};
    return names[static_cast<std::size_t>(fault)];
}

Result<FaultRates> parse_fault_rates(std::string_view text) {
    FaultRates rates;
    std::set<std::string_view> seen;
    for (const std::string_view part : split(text, ',')) {
        const std::size_t equals = part.find('=');
        if (equals == std::string_view::npos) {
            return fail(ErrorCode::bad_argument,
                        "faults: '{}' is not NAME=NUMBER; write, for example, {}", part, example);
        }
        const std::string_view key = part.substr(0, equals);
        if (!seen.insert(key).second) {
            return fail(ErrorCode::bad_argument, "faults: {} is given twice", key);
        }
        auto done = set(rates, key, part.substr(equals + 1));
        if (!done) return pass_on(done);
    }
    if (rates.drop + rates.repeat + rates.reorder + rates.truncate > 1 + 1e-9) {
        return fail(ErrorCode::bad_argument, "faults: the probabilities add up to more than 1");
    }
    return rates;
}

std::vector<Arrival> arrivals_of(const FaultRates& rates, std::uint32_t row, std::size_t pieces) {
    std::vector<Arrival> arrivals;
    arrivals.reserve(pieces);
    for (std::size_t i = 0; i < pieces; ++i) {
        DrawPlace place;
        place.volume = row;
        place.radial = static_cast<std::uint32_t>(i);
        const RandomWords words = draw(rates.seed, Draw::replay_fault, place);
        Arrival arrival;
        arrival.piece = i;
        arrival.fault = fault_of(rates, uniform_of(words[0]));
        if (arrival.fault == Fault::truncate) arrival.kept = uniform_of(words[1]);
        if (arrival.fault == Fault::reorder && i + 1 == pieces) arrival.fault = Fault::none;
        if (arrival.fault == Fault::reorder) {
            ++i;
            arrivals.push_back({i});
        }
        arrivals.push_back(arrival);
        if (arrival.fault == Fault::repeat) {
            arrival.again = true;
            arrivals.push_back(arrival);
        }
    }
    return arrivals;
}

std::size_t kept_bytes(const Arrival& arrival, std::size_t bytes) {
    if (arrival.fault == Fault::drop) return 0;
    if (arrival.fault != Fault::truncate || bytes < 2) return bytes;
    const auto kept = static_cast<std::size_t>(arrival.kept * static_cast<double>(bytes));
    return std::clamp<std::size_t>(kept, 1, bytes - 1);
}

}  // namespace stormcellar::synth
