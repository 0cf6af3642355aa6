// stormcellar.h -- the C interface of stormcellar: reads, grids and draws weather radar data.
//
// Every function that can fail returns a stormcellar_code: STORMCELLAR_OK, or the kind of the
// failure. A failed call also writes the code and one line for people into `error`, unless `error`
// is null. A null pointer in place of an object gives STORMCELLAR_BAD_ARGUMENT.
//
// Objects are constant after they are made, so many threads may use one object. An object is freed
// once, when no thread uses it. Nothing else is shared: the library has no global state.
//
// Structs whose first member is `size` may grow at their end in later versions. Set `size` to
// sizeof the struct before a call; the library reads and writes only `size` bytes.
//
// Units     Degrees, meters, milliseconds since 1970-01-01 00:00 UTC, and the unit of each moment.
//           Heights are above mean sea level. Unknown numbers are NaN, unknown times INT64_MIN.
// Language  C99.
#ifndef STORMCELLAR_H
#define STORMCELLAR_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define STORMCELLAR_API __attribute__((visibility("default")))
#else
#define STORMCELLAR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

// Returns the version of the library, such as "0.2.0".
STORMCELLAR_API const char* stormcellar_version(void);

typedef enum stormcellar_code {
    STORMCELLAR_OK = 0,
    STORMCELLAR_BAD_ARGUMENT = 1,  // the caller asked for something that makes no sense
    STORMCELLAR_NOT_FOUND = 2,     // the thing named does not exist
    STORMCELLAR_EMPTY = 3,         // the input holds no bytes
    STORMCELLAR_TRUNCATED = 4,     // the input ends before anything whole
    STORMCELLAR_CORRUPT = 5,       // the input contradicts itself or its checksum
    STORMCELLAR_UNSUPPORTED = 6,   // valid, but of a kind that this library does not handle
    STORMCELLAR_NOT_LEVEL2 = 7,    // the input is not a Level II file
    STORMCELLAR_NOT_A_FILE = 8,    // a directory, FIFO or other thing that is not a regular file
    STORMCELLAR_IO = 9,            // the operating system refused a read or a write
    STORMCELLAR_EXHAUSTED = 10,    // there is no more memory, or no descriptor
    STORMCELLAR_BUSY = 11,         // another process holds what is needed
    STORMCELLAR_NO_SPACE = 12,     // the file system is full
    STORMCELLAR_OVER_BUDGET = 13,  // an allowance of disk or memory is used up
    STORMCELLAR_UNMET = 14,        // no allowed choice meets the requested error or time
    STORMCELLAR_PERMISSION = 15,   // the file may not be read or written
    STORMCELLAR_INTERNAL = 16      // a defect of the library
} stormcellar_code;

typedef struct stormcellar_error {
    int32_t code;        // a stormcellar_code
    char message[1020];  // UTF-8, ends with 0; a longer message is cut
} stormcellar_error;

// A decoded volume: sweeps of radials, with moments of gates.
typedef struct stormcellar_volume stormcellar_volume;

typedef struct stormcellar_read_options {
    size_t size;
    int32_t threads;      // 0: one
    int32_t volume;       // number in a file of several volumes, from 1; 0: the first
    const char* moments;  // names between blanks, "REF VEL", to decode only these; null: all
    const char* station;  // if the file has no station: "KTLX"; null: from the file's name
} stormcellar_read_options;

// Reads a volume from a file, from bytes, or from the descriptor of a regular file. A descriptor is
// read from its position to the end of the file. The file may be compressed. Null options mean that
// all options are zero. The bytes may be freed after the call.
STORMCELLAR_API stormcellar_code stormcellar_volume_open(const char* path,
                                                         const stormcellar_read_options* options,
                                                         stormcellar_volume** volume,
                                                         stormcellar_error* error);
STORMCELLAR_API stormcellar_code stormcellar_volume_from_bytes(
    const void* bytes, size_t size, const stormcellar_read_options* options,
    stormcellar_volume** volume, stormcellar_error* error);
STORMCELLAR_API stormcellar_code
stormcellar_volume_from_descriptor(int descriptor, const stormcellar_read_options* options,
                                   stormcellar_volume** volume, stormcellar_error* error);
// Frees a volume; null is allowed.
STORMCELLAR_API void stormcellar_volume_free(stormcellar_volume* volume);

typedef struct stormcellar_volume_facts {
    size_t size;
    char station[8];  // "KTLX", or empty
    double latitude_deg, longitude_deg;
    double altitude_m;  // of the antenna
    int64_t start_ms;
    int32_t vcp;       // volume coverage pattern; -1: unknown
    int32_t sweeps;    // number of sweeps
    int32_t complete;  // 1 if the volume ended and nothing of it is missing
    int32_t volumes;   // number of volumes in the file
    int32_t problems;  // number of problems that the decoder reports
} stormcellar_volume_facts;

STORMCELLAR_API stormcellar_code stormcellar_volume_describe(const stormcellar_volume* volume,
                                                             stormcellar_volume_facts* facts,
                                                             stormcellar_error* error);
// Copies one problem as one line; problems are numbered from 0. The line is cut to at most `size`
// bytes, of which the last is 0.
STORMCELLAR_API stormcellar_code stormcellar_volume_problem(const stormcellar_volume* volume,
                                                            int32_t problem, char* text,
                                                            size_t size, stormcellar_error* error);

typedef struct stormcellar_sweep_facts {
    size_t size;
    double elevation_deg;        // mean of the radials
    double fixed_angle_deg;      // of the pattern
    double azimuth_spacing_deg;  // 0.5 or 1
    int64_t start_ms, end_ms;    // of the first and the last radial
    int32_t elevation_number;    // the cut of the pattern, from 1
    int32_t radials;             // number of radials
    int32_t moments;             // number of moments
} stormcellar_sweep_facts;

// Sweeps are numbered from 0 in the order of the file.
STORMCELLAR_API stormcellar_code stormcellar_sweep_describe(const stormcellar_volume* volume,
                                                            int32_t sweep,
                                                            stormcellar_sweep_facts* facts,
                                                            stormcellar_error* error);

typedef struct stormcellar_radial {
    int64_t time_ms;
    float azimuth_deg, elevation_deg;
    float nyquist_mps;  // 0: unknown
    float unambiguous_range_m;
    int32_t status;  // as in the file: 0 first of a sweep, 2 last of a sweep, 3 and 4 of a volume
    int32_t azimuth_number;
} stormcellar_radial;

// Copies the radials of a sweep, in the order of the file. `count` must be their number.
STORMCELLAR_API stormcellar_code stormcellar_sweep_radials(const stormcellar_volume* volume,
                                                           int32_t sweep,
                                                           stormcellar_radial* radials,
                                                           size_t count, stormcellar_error* error);

// The state of a gate.
typedef enum stormcellar_gate_state {
    STORMCELLAR_GATE_VALUE = 0,
    STORMCELLAR_GATE_BELOW_THRESHOLD = 1,
    STORMCELLAR_GATE_RANGE_FOLDED = 2,
    STORMCELLAR_GATE_NO_DATA = 3,   // not measured, or beyond the gates of the radial
    STORMCELLAR_GATE_AMBIGUOUS = 4  // echo whose derived value is uncertain
} stormcellar_gate_state;

// Gates are in rows, one for each radial of the sweep. A value is (code - offset) / scale, or the
// code if the scale is 0. If the radials of a sweep differ in their gates, the sweep has the moment
// once for each kind of radial, with no gates in the rows of other radials.
typedef struct stormcellar_moment_facts {
    size_t size;
    char name[8];            // "REF"
    char unit[16];           // "dBZ"; "1": no unit
    int32_t gates;           // codes in a row
    int32_t first_gate_m;    // slant range to the center of the first gate
    int32_t gate_spacing_m;  // between centers
    int32_t code_bytes;      // 1 or 2
    int32_t first_valid_code;
    float scale, offset;
} stormcellar_moment_facts;

// Moments of a sweep are numbered from 0.
STORMCELLAR_API stormcellar_code stormcellar_moment_describe(const stormcellar_volume* volume,
                                                             int32_t sweep, int32_t moment,
                                                             stormcellar_moment_facts* facts,
                                                             stormcellar_error* error);
// Finds the number of the first moment of this name. STORMCELLAR_NOT_FOUND if there is no such
// moment.
STORMCELLAR_API stormcellar_code stormcellar_moment_find(const stormcellar_volume* volume,
                                                         int32_t sweep, const char* name,
                                                         int32_t* moment, stormcellar_error* error);
// Points to the codes, radials times gates of 1 or 2 bytes. The codes live as long as the volume.
STORMCELLAR_API stormcellar_code stormcellar_moment_codes(const stormcellar_volume* volume,
                                                          int32_t sweep, int32_t moment,
                                                          const void** codes,
                                                          stormcellar_error* error);
// Writes the values of the gates; NaN for a gate without a value. `count` must be radials times
// gates.
STORMCELLAR_API stormcellar_code stormcellar_moment_values(const stormcellar_volume* volume,
                                                           int32_t sweep, int32_t moment,
                                                           float* values, size_t count,
                                                           stormcellar_error* error);
// Writes the states (stormcellar_gate_state), one byte each. `count` must be radials times gates.
STORMCELLAR_API stormcellar_code stormcellar_moment_states(const stormcellar_volume* volume,
                                                           int32_t sweep, int32_t moment,
                                                           uint8_t* states, size_t count,
                                                           stormcellar_error* error);

typedef struct stormcellar_derive_options {
    size_t size;
    const char* dealias;       // auto, off, profile, region or anchored; null: auto
    const char* storm_motion;  // of SRV: auto, right, left, mean, or "240/15"; null: auto
    double quality;            // leave out gates with a lesser probability of weather; 0: keep all
} stormcellar_derive_options;

// Returns a copy of the volume with derived moments, named between blanks: VELD (dealiased
// velocity), SRV (relative to a storm), AZSH (azimuthal shear), DIVG (divergence), POW (probability
// of weather), KDP (specific differential phase), RATE (rain rate), HCA (classes of hydrometeors).
// Methods and errors: docs/velocity.md, docs/quality.md, docs/storms.md. Null options are the
// defaults.
STORMCELLAR_API stormcellar_code
stormcellar_volume_derive(const stormcellar_volume* volume, const char* moments,
                          const stormcellar_derive_options* options, stormcellar_volume** derived,
                          stormcellar_error* error);

// A grid of one moment: columns from west to east, rows from south to north, and levels.
typedef struct stormcellar_grid stormcellar_grid;

// Members that are 0 or null have the defaults of `stormcellar grid`: 460 by 460 columns of 1 km
// about the radar, and 32 levels.
typedef struct stormcellar_grid_options {
    size_t size;
    const char* moment;  // null: reflectivity
    int32_t columns, rows;
    double spacing_m;
    const double* levels_m;  // heights above mean sea level, rising
    int32_t level_count;
    int32_t has_center;  // 1: the grid is about the center below; 0: about the radar
    double center_latitude_deg, center_longitude_deg;
    const char* interpolation;  // nearest, linear, eight-point or beam-weighted; null: linear
    int32_t mean_of_cell;       // 1: the mean over the cell; 0: a point at its center
    int32_t average_in_z;       // 1: reflectivity is averaged as power
    int32_t threads;            // 0: one
} stormcellar_grid_options;

// Grids a volume on a plane about the center (azimuthal equidistant on WGS84). Accuracy:
// docs/accuracy.md.
STORMCELLAR_API stormcellar_code stormcellar_grid_make(const stormcellar_volume* volume,
                                                       const stormcellar_grid_options* options,
                                                       stormcellar_grid** grid,
                                                       stormcellar_error* error);

typedef struct stormcellar_mosaic_options {
    size_t size;
    const char* overlap;  // mean, maximum, nearest or distance-weighted; null: as the moment allows
    double length_m;      // a site at distance r has the weight exp(-r^2 / length^2); 0: 250 km
} stormcellar_mosaic_options;

// Grids volumes of several radars, or of several times, and merges the grids for one instant, as
// `stormcellar grid FILE FILE` does. The instant is the middle of the newest volumes. Without a
// center, the grid reaches 230 km beyond the radars. Rules and accuracy: docs/geometry.md.
STORMCELLAR_API stormcellar_code stormcellar_mosaic_make(
    const stormcellar_volume* const* volumes, size_t count, const stormcellar_grid_options* options,
    const stormcellar_mosaic_options* mosaic_options, stormcellar_grid** mosaic,
    stormcellar_error* error);
// Merges grids of different radars. The grids must have the same moment and the same cells. Echo is
// not moved to a common time. Values are rounded to the steps of the cache (0.5 dBZ).
STORMCELLAR_API stormcellar_code stormcellar_grid_merge(const stormcellar_grid* const* grids,
                                                        size_t count,
                                                        const stormcellar_mosaic_options* options,
                                                        stormcellar_grid** merged,
                                                        stormcellar_error* error);
// Frees a grid; null is allowed.
STORMCELLAR_API void stormcellar_grid_free(stormcellar_grid* grid);

typedef struct stormcellar_grid_facts {
    size_t size;
    char moment[8];
    char unit[16];
    int32_t columns, rows, levels;
    int32_t mean_of_cell;  // 1: values are means over their cells
    double spacing_m;
    double center_latitude_deg, center_longitude_deg;
    int64_t time_ms;           // start of the volume; instant of a mosaic
    int64_t start_ms, end_ms;  // of the radials that were used
    char projection[24];       // azimuthal_equidistant, lambert_conformal or latitude_longitude
    double spacing_deg;        // of a grid in degrees, whose spacing_m is 0
    double parallels_deg[2];   // of lambert_conformal
    // The middle of the grid is this many cells to the east and to the north of the center.
    double offset_x_cells, offset_y_cells;
} stormcellar_grid_facts;

STORMCELLAR_API stormcellar_code stormcellar_grid_describe(const stormcellar_grid* grid,
                                                           stormcellar_grid_facts* facts,
                                                           stormcellar_error* error);

// The state of a cell.
typedef enum stormcellar_cell_state {
    STORMCELLAR_CELL_NOT_SEEN = 0,
    STORMCELLAR_CELL_NO_ECHO = 1,
    STORMCELLAR_CELL_RANGE_FOLDED = 2,
    STORMCELLAR_CELL_VALUE = 3,
    STORMCELLAR_CELL_AMBIGUOUS = 5
} stormcellar_cell_state;

// Point to the heights of the levels, the values, and the states of the cells (one byte each).
// Cells are in rows of columns of levels: cell (row, column, level) is at
// (row * columns + column) * levels + level. A value counts only if the state is
// STORMCELLAR_CELL_VALUE. The arrays live as long as the grid.
STORMCELLAR_API stormcellar_code stormcellar_grid_levels(const stormcellar_grid* grid,
                                                         const double** levels_m,
                                                         stormcellar_error* error);
STORMCELLAR_API stormcellar_code stormcellar_grid_values(const stormcellar_grid* grid,
                                                         const float** values,
                                                         stormcellar_error* error);
STORMCELLAR_API stormcellar_code stormcellar_grid_states(const stormcellar_grid* grid,
                                                         const uint8_t** states,
                                                         stormcellar_error* error);

// A table of how exact and how fast each way of gridding (rung) is on a volume, as `stormcellar
// accuracy` measures it (docs/accuracy.md).
typedef struct stormcellar_ladder stormcellar_ladder;

typedef struct stormcellar_ladder_options {
    size_t size;
    int32_t columns;  // number of columns that are compared; 0: 2,000
    int32_t rounds;   // number of timings, of which the fastest counts; 0: 3
} stormcellar_ladder_options;

// Measures on the grid that the options describe, without their interpolation and mean_of_cell.
// Takes 20 s for the usual grid.
STORMCELLAR_API stormcellar_code stormcellar_ladder_measure(
    const stormcellar_volume* volume, const stormcellar_grid_options* options,
    const stormcellar_ladder_options* ladder_options, stormcellar_ladder** ladder, size_t* count,
    stormcellar_error* error);
// Frees a ladder; null is allowed.
STORMCELLAR_API void stormcellar_ladder_free(stormcellar_ladder* ladder);

// One way of doing a step, compared with the exact chain on the same gates. The texts live as long
// as the ladder.
typedef struct stormcellar_rung {
    size_t size;
    const char* step;     // "interpolation"; "chain": a whole chain
    const char* name;     // "eight-point"
    char value_unit[16];  // "dB"
    int32_t rung;         // from cheap to exact, from 0
    int32_t pareto;       // 1 if no other rung of the step is as fast and as exact
    double time_s;        // of the first grid
    double kept_time_s;   // of further grids with the same geometry
    double position_max_m, position_rms_m;
    double value_rms, value_p95, value_p99, value_max;  // of cells with a value in both chains
    double status_disagreement;                         // share of cells whose states differ
} stormcellar_rung;

STORMCELLAR_API stormcellar_code stormcellar_ladder_describe(const stormcellar_ladder* ladder,
                                                             size_t index, stormcellar_rung* rung,
                                                             stormcellar_error* error);

// A picture: the bytes of a PNG file, or pixels in rows from the top. A pixel is red, green, blue
// and alpha (sRGB, alpha not premultiplied).
typedef struct stormcellar_picture stormcellar_picture;

typedef enum stormcellar_picture_format {
    STORMCELLAR_RGBA = 0,
    STORMCELLAR_PNG = 1
} stormcellar_picture_format;

typedef struct stormcellar_draw_options {
    size_t size;
    const char* product;    // volume, ppi, composite, ...; null: volume
    const char* moment;     // null: the grid's or the product's, or else REF
    int32_t width, height;  // pixels; 0: 796, 532
    // Further options of `stormcellar frame`, such as "theme=light" and "tilt=40".
    const char* const* settings;
    int32_t setting_count;
    int32_t format;   // a stormcellar_picture_format
    int32_t threads;  // 0: one
} stormcellar_draw_options;

// Draw a volume, or a grid, as `stormcellar frame` does with the same options: a PNG has the same
// bytes. Neither products over several volumes nor marks of storm cells are drawn. Null options
// draw reflectivity in three dimensions.
STORMCELLAR_API stormcellar_code stormcellar_volume_draw(const stormcellar_volume* volume,
                                                         const stormcellar_draw_options* options,
                                                         stormcellar_picture** picture,
                                                         stormcellar_error* error);
STORMCELLAR_API stormcellar_code stormcellar_grid_draw(const stormcellar_grid* grid,
                                                       const stormcellar_draw_options* options,
                                                       stormcellar_picture** picture,
                                                       stormcellar_error* error);
// Frees a picture; null is allowed.
STORMCELLAR_API void stormcellar_picture_free(stormcellar_picture* picture);

typedef struct stormcellar_picture_facts {
    size_t size;
    int32_t width, height;
    size_t bytes;
} stormcellar_picture_facts;

STORMCELLAR_API stormcellar_code stormcellar_picture_describe(const stormcellar_picture* picture,
                                                              stormcellar_picture_facts* facts,
                                                              stormcellar_error* error);
// Points to the pixels or to the bytes of the file. They live as long as the picture.
STORMCELLAR_API stormcellar_code stormcellar_picture_bytes(const stormcellar_picture* picture,
                                                           const uint8_t** bytes,
                                                           stormcellar_error* error);

// Members that are 0 or null select everything.
typedef struct stormcellar_query {
    size_t size;
    const char* name;        // a station of a catalog, a domain of a cache
    const char* moment;      // of grids in a cache: names between blanks, "REF VEL"
    int64_t from_ms, to_ms;  // start of a volume, or time of a grid; both included
} stormcellar_query;

// A catalog of raw files (docs/catalog.md), opened to read, while a service may write to it.
typedef struct stormcellar_catalog stormcellar_catalog;
typedef struct stormcellar_file_list stormcellar_file_list;

STORMCELLAR_API stormcellar_code stormcellar_catalog_open(const char* directory,
                                                          stormcellar_catalog** catalog,
                                                          stormcellar_error* error);
// Frees a catalog; null is allowed.
STORMCELLAR_API void stormcellar_catalog_free(stormcellar_catalog* catalog);
// Lists volumes by station, then by start. Without a station, leaves out stations whose databases
// cannot be read.
STORMCELLAR_API stormcellar_code stormcellar_catalog_list(const stormcellar_catalog* catalog,
                                                          const stormcellar_query* query,
                                                          stormcellar_file_list** list,
                                                          size_t* count, stormcellar_error* error);
// Frees a list; null is allowed.
STORMCELLAR_API void stormcellar_file_list_free(stormcellar_file_list* list);

// A volume in a file. The texts live as long as the list.
typedef struct stormcellar_file_facts {
    size_t size;
    const char* path;    // for stormcellar_volume_open(), unless the state is gone
    const char* reason;  // why the file is partial, or a remark
    char station[8];
    char state[16];  // of the file: seen (not decoded yet), complete, partial, rejected or gone
    int64_t start_ms, end_ms;
    uint64_t bytes;  // of the file
    int32_t volume;  // number in the file, from 1
    int32_t vcp;     // -1: unknown
    int32_t sweeps, radials;
    int32_t complete;  // 1 if nothing of the volume is missing
} stormcellar_file_facts;

STORMCELLAR_API stormcellar_code stormcellar_file_list_describe(const stormcellar_file_list* list,
                                                                size_t index,
                                                                stormcellar_file_facts* facts,
                                                                stormcellar_error* error);

// A directory of grid files (docs/cache-format.md), opened to read.
typedef struct stormcellar_cache stormcellar_cache;
typedef struct stormcellar_grid_list stormcellar_grid_list;

STORMCELLAR_API stormcellar_code stormcellar_cache_open(const char* directory,
                                                        stormcellar_cache** cache,
                                                        stormcellar_error* error);
// Frees a cache; null is allowed.
STORMCELLAR_API void stormcellar_cache_free(stormcellar_cache* cache);
// Lists grids by domain, moment and time. Opens no grid.
STORMCELLAR_API stormcellar_code stormcellar_cache_list(const stormcellar_cache* cache,
                                                        const stormcellar_query* query,
                                                        stormcellar_grid_list** list, size_t* count,
                                                        stormcellar_error* error);
// Frees a list; null is allowed.
STORMCELLAR_API void stormcellar_grid_list_free(stormcellar_grid_list* list);

// A grid file. The texts live as long as the list.
typedef struct stormcellar_grid_file_facts {
    size_t size;
    const char* path;
    const char* domain;
    char moment[8];
    int64_t time_ms;
    uint64_t bytes;  // on disk
} stormcellar_grid_file_facts;

STORMCELLAR_API stormcellar_code stormcellar_grid_list_describe(const stormcellar_grid_list* list,
                                                                size_t index,
                                                                stormcellar_grid_file_facts* facts,
                                                                stormcellar_error* error);
// Reads a grid file, and checks its checksums. No other program may cut the file meanwhile.
STORMCELLAR_API stormcellar_code stormcellar_grid_read(const char* path, stormcellar_grid** grid,
                                                       stormcellar_error* error);

#ifdef __cplusplus
}
#endif

#endif
