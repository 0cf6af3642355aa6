// web/doors/api/operations.h -- the table of all operations of the API. The operation for a request
// is found in it, and the OpenAPI document and the table in docs/web/grids.md are generated from
// it.
//
// Threads   Constants.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "web/doors/api/call.h"

namespace stormcellar::web {

enum class ApiKind { text, number, whole };

struct ApiParameter {
    std::string_view name;
    std::string_view what;
    ApiKind kind = ApiKind::text;
    bool required = false;
};

struct ApiOperation {
    std::string_view name;
    std::string_view path;                     // "{domain}" matches any segment
    std::string_view what;                     // a sentence
    std::span<const ApiParameter> parameters;  // of the query
    std::string_view content_type;
    std::span<const unsigned> errors;
    Answer (*answer)(const ApiCall& call);
    // Returns the answer if it is in memory; takes microseconds. Null for operations that keep no
    // answers.
    std::optional<Answer> (*answer_at_once)(const ApiCall& call) = nullptr;
};

[[nodiscard]] std::span<const ApiOperation> api_operations();
// Returns a description of a path segment, by its name in braces; empty if the name is unknown.
[[nodiscard]] std::string_view api_path_parameter(std::string_view name);
// Returns the OpenAPI 3.1 document.
[[nodiscard]] ApiJson openapi_document(std::string_view base);

// The functions that do the operations.
Answer api_index(const ApiCall& call);
Answer api_openapi(const ApiCall& call);
Answer api_stations(const ApiCall& call);
Answer api_volumes(const ApiCall& call);
Answer api_sweeps(const ApiCall& call);
Answer api_gates(const ApiCall& call);
Answer api_wind(const ApiCall& call);
Answer api_domains(const ApiCall& call);
Answer api_grids(const ApiCall& call);
Answer api_grid(const ApiCall& call);
Answer api_packed(const ApiCall& call);
std::optional<Answer> api_packed_at_once(const ApiCall& call);
Answer api_probe(const ApiCall& call);
Answer api_profile(const ApiCall& call);
Answer api_netcdf(const ApiCall& call);
Answer api_grid_file(const ApiCall& call);
Answer api_view(const ApiCall& call);
Answer api_between(const ApiCall& call);
Answer api_regions(const ApiCall& call);
Answer api_region_packed(const ApiCall& call);
Answer api_region_sites(const ApiCall& call);
Answer api_cells(const ApiCall& call);
Answer api_rotation(const ApiCall& call);
Answer api_map(const ApiCall& call);
Answer api_tables(const ApiCall& call);
Answer api_no_events(const ApiCall& call);

}  // namespace stormcellar::web
