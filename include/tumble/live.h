/* A run of a scene from its text, piece by piece, for C and for every language that calls C. The live part of pages has
 * the same functions, compiled to WebAssembly.
 *
 *     struct tumble_run* run = tumble_open("ball.toml", text, "body.ball.restitution=0.65\n");
 *     if (tumble_error(run)[0] == '\0') tumble_advance(run, tumble_frames(run));
 *     if (tumble_error(run)[0] != '\0') fprintf(stderr, "%s\n", tumble_error(run));
 *     size_t size = 0;
 *     const unsigned char* clip = tumble_data(run, &size);
 *     ...
 *     tumble_close(run);
 *
 * No function throws. Different runs may be used by different threads at the same time. The same text and settings give
 * the same bytes on every machine. Scenes that need files (meshes, textures, height maps, images of environments) are
 * read relative to the folder of `name`; WebAssembly has no files and reports an error. */
#ifndef TUMBLE_LIVE_H
#define TUMBLE_LIVE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tumble_run;

/* A run of a scene. `name`: of the scene file, for messages. `text`: of the scene (TOML), UTF-8. `settings`: lines of
 * PATH=VALUE, as of `tumble simulate --set`; empty or null: none. Null only where memory is exhausted; an invalid scene
 * gives a run with an error and no frames. */
struct tumble_run* tumble_open(const char* name, const char* text, const char* settings);

/* Frees the run. Null is allowed. */
void tumble_close(struct tumble_run* run);

/* Frames of the whole clip; 0 of an invalid scene. */
int32_t tumble_frames(const struct tumble_run* run);

/* Simulates up to `frames` more frames, and returns how many there are now. Stops early where the simulation fails:
 * then there is an error, and the frames until then remain. */
int32_t tumble_advance(struct tumble_run* run, int32_t frames);

/* The mistake or failure, as "ball.toml:12:5: message"; empty: nothing. Valid until the next call with this run. */
const char* tumble_error(const struct tumble_run* run);

/* Line and column of the error in the text, from 1; 0: it has no place there. */
int32_t tumble_error_line(const struct tumble_run* run);
int32_t tumble_error_column(const struct tumble_run* run);

/* The frames until now as the data of a clip, as `tumble page` puts it into a page, before compression
 * (docs/reference/c-api.md). Valid until the next call with this run; null without frames. */
const unsigned char* tumble_data(struct tumble_run* run, size_t* size);

#ifdef __cplusplus
}
#endif

#endif
