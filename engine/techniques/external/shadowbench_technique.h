/* A technique from outside: what a shared library offers that shadowbench loads with --technique-library FILE.
 *
 * The library exports one function, shadowbench_techniques(). All else is reached from what it returns. Everything here
 * is plain C: no C++ type and no exception crosses the border. shadowbench_technique.hpp makes such a library of a C++
 * function or class. engine/techniques/README.md says what a map must do; this file says how it is asked.
 *
 * Functions that may fail return NULL for success, or a message: UTF-8, one line, valid until the same thread calls the
 * library again. A message fails the technique's own row of the result and nothing else. */
#ifndef SHADOWBENCH_TECHNIQUE_H
#define SHADOWBENCH_TECHNIQUE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Grows when a struct or the meaning of a function changes. A library of another version is refused. */
#define SHADOWBENCH_TECHNIQUE_ABI 1

/* What a function that returns a count returns if it fails. */
#define SHADOWBENCH_FAILED ((size_t)-1)

/* --- parameters --- */

enum {
    SHADOWBENCH_NUMBER = 0,        /* in [min, max] */
    SHADOWBENCH_INTEGER = 1,       /* in [min, max] */
    SHADOWBENCH_CHOICE = 2,        /* one of the words */
    SHADOWBENCH_NUMBER_OR_WORD = 3 /* in [min, max], or one of the words */
};

typedef struct shadowbench_parameter {
    const char* name; /* lower-case letters, digits and _, as for the id of a technique */
    const char* doc;  /* one line: what it means, in which unit */
    int32_t kind;
    double standard, min, max; /* the default and the range, inclusive */
    const char* standard_word; /* the default if it is a word, else NULL */
    const char* const* words;
    size_t word_count;
} shadowbench_parameter;

/* The value of a parameter. Functions get one for each parameter, in the order in which they are declared; words are
 * gone when the function returns. */
typedef struct shadowbench_value {
    double number;
    const char* word; /* NULL: it is the number */
} shadowbench_value;

/* What shadowbench recommend varies, because it trades cost against error. */
enum {
    SHADOWBENCH_LINEAR = 0,      /* equal steps from `from`, the cheapest value, to `to`, the most accurate */
    SHADOWBENCH_LOGARITHMIC = 1, /* equal ratios; both above 0 */
    SHADOWBENCH_WORDS = 2        /* every word of the parameter; `from` and `to` are not read */
};

typedef struct shadowbench_trade {
    const char* parameter;
    int32_t scale;
    double from, to;
} shadowbench_trade;

/* --- light rays and queries --- */

typedef struct shadowbench_layout {
    int32_t width, height;           /* of the map, pixels */
    int32_t samples_x, samples_y;    /* rays of a pixel along each side */
    int32_t tile_width, tile_height; /* pixels; tiles at the right and top edge may be smaller */
    int32_t media;                   /* whether any segment may have z_front < z_back */
    float z_min, z_max;              /* bounds of every depth that occurs; may be equal */
} shadowbench_layout;

/* The light rays of one tile. Ray r has the segments begin[r] to begin[r + 1] - 1, sorted by z_front, then z_back. Rays
 * are ordered by pixel (row after row of the tile), then by sample (row after row of the pixel). A surface has z_front
 * == z_back and shades what lies strictly behind it. A medium has a constant extinction between its ends. Segments may
 * overlap: their transmittances multiply. */
typedef struct shadowbench_rays {
    int32_t x0, y0, width, height; /* pixels of the map */
    int32_t samples;               /* rays of a pixel */
    const uint32_t* begin;         /* width * height * samples + 1 */
    const float* z_front;
    const float* z_back;        /* NULL if the tile holds only surfaces */
    const float* transmittance; /* in [0, 1] */
} shadowbench_rays;

/* How much light reaches (x, y, z) over a footprint `width` pixels wide? Any floats are asked. Outside the map, or at a
 * position of NaN: 1. A depth of NaN lies before everything. A width that is negative or NaN counts as 0. */
typedef struct shadowbench_query {
    float x, y;  /* map pixels */
    float z;     /* depth */
    float width; /* of the filter, map pixels */
} shadowbench_query;

/* The receiver's own pixel in the map: a parallelogram around the query. All 0, or not finite: not known. */
typedef struct shadowbench_footprint {
    float ux, uy, vx, vy;
} shadowbench_footprint;

/* Stored functions are piecewise linear in depth. Two vertices at one z are a step; a function has its first value up
 * to its first vertex, also at a step there, and its last value behind the last vertex. No vertices: 1 everywhere. */
typedef struct shadowbench_vertex {
    float z, value;
} shadowbench_vertex;

/* --- a technique --- */

/* Which rays a stored function stands for. */
enum {
    SHADOWBENCH_CELL_PIXEL = 0,  /* the mean of all rays of a pixel */
    SHADOWBENCH_CELL_SAMPLE = 1, /* one ray; the map is samples_x by samples_y times as large */
    SHADOWBENCH_CELL_CENTRE = 2, /* the ray of the pixel's middle sample (samples_x / 2, samples_y / 2) */
    SHADOWBENCH_CELL_NONE = 3    /* functions cannot be shown; their error is not measured */
};

/* What holds for every stored function in every scene. Each run checks it; who breaks a promise fails. */
typedef struct shadowbench_promises {
    int32_t monotone;    /* never rises with depth */
    int32_t unit_range;  /* stays in [0, 1] */
    int32_t opaque_only; /* counts every surface as opaque: bounds hold only in opaque scenes */
    int32_t localised;   /* one surface counts at its own depth; else only before and behind all are promised */
    int32_t approximate; /* fits or bounds its functions: see leak */
    int32_t early;       /* may be dark before the first surface */
    double leak;         /* the light that may be left behind something opaque; for approximate techniques the largest
                            error behind everything */
} shadowbench_promises;

typedef struct shadowbench_technique {
    const char* id;    /* lower-case letters, digits and _ */
    const char* title; /* one line */
    const char* paper; /* "authors year" */
    int32_t version;   /* from 1; grows when the same rays give other answers or bytes */
    int32_t cells;
    shadowbench_promises promises;
    const shadowbench_parameter* parameters;
    size_t parameter_count;
    const shadowbench_trade* trades;
    size_t trade_count;

    /* Makes an empty map. A coloured scene gets one for each colour channel. */
    const char* (*create)(const shadowbench_value* values, size_t value_count, const shadowbench_layout* layout,
                          void** map);
    void (*destroy)(void* map);
    /* Called once for each tile, from several threads at once for different tiles. The rays are gone afterwards. */
    const char* (*add)(void* map, const shadowbench_rays* tile);
    /* Called once, last. The map does not change afterwards; the functions below may run on several threads. */
    const char* (*finish)(void* map);

    /* Writes `count` answers, all finite, and in [0, 1] if that is promised. `footprints` has one for each query, or is
     * NULL. */
    const char* (*lookup)(const void* map, const shadowbench_query* queries, const shadowbench_footprint* footprints,
                          size_t count, float* visibility);
    /* Bytes that the finished map holds, and the most that were held while building besides the rays. */
    const char* (*bytes)(const void* map, uint64_t* held, uint64_t* working);

    /* The following may be NULL. Those that return a number report a fault by SHADOWBENCH_FAILED (nodes:
     * UINT32_MAX). */

    /* Nodes that cell (x, y) stores. NULL: not counted. */
    uint32_t (*nodes)(const void* map, int32_t x, int32_t y);
    /* Writes at most `capacity` vertices of the function of cell (x, y), and returns their number. If it is above
     * `capacity`, the function is called again with room for as many. A function that is not piecewise linear is
     * sampled at its own nodes and at `depths` (sorted). NULL only with SHADOWBENCH_CELL_NONE. */
    size_t (*stored)(const void* map, int32_t x, int32_t y, const float* depths, size_t depth_count,
                     shadowbench_vertex* out, size_t capacity);
    /* The same for the lines of memory that a lookup reads: an address in each 64-byte line, once, and no other. The
     * addresses are read, to time the floor of the lookup. NULL: lookups are timed without a floor. */
    size_t (*touched)(const void* map, const shadowbench_query* query, const shadowbench_footprint* footprint,
                      const void** lines, size_t capacity);
    /* The largest curve error that these values promise. NULL: none is promised. */
    double (*error_bound)(const shadowbench_value* values, size_t value_count, const shadowbench_layout* layout);
    /* The least bytes that a finished map of this layout holds, to refuse what cannot fit. NULL: 0. */
    uint64_t (*least_bytes)(const shadowbench_value* values, size_t value_count, const shadowbench_layout* layout);
} shadowbench_technique;

typedef struct shadowbench_library {
    uint32_t abi; /* SHADOWBENCH_TECHNIQUE_ABI; read before anything else */
    uint32_t technique_count;
    size_t technique_size; /* sizeof(shadowbench_technique) */
    const shadowbench_technique* techniques;
} shadowbench_library;

/* The one exported function. What it returns stays as it is until the program ends. */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const shadowbench_library* shadowbench_techniques(void);

#ifdef __cplusplus
}
#endif

#endif
