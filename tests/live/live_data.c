/* The interface of C. live_data OUT NAME SCENE_FILE [PATH=VALUE]... writes the data of a run; live_data --check tests
 * the interface; live_data --time SCENE_FILE prints the processor time of a run with its data, ms, median of 9. */
#include <tumble/live.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static int failed = 0;

static void check(int holds, const char* what) {
    if (holds) return;
    fprintf(stderr, "live_data: failed: %s\n", what);
    failed = 1;
}

static const char* const ball =
    "format = 1\n"
    "[simulation]\n"
    "duration = 1.0\n"
    "impacts = \"exact\"\n"
    "[[body]]\n"
    "name = \"floor\"\n"
    "type = \"fixed\"\n"
    "shape = { type = \"plane\" }\n"
    "[[body]]\n"
    "name = \"ball\"\n"
    "shape = { type = \"sphere\", radius = 0.1 }\n"
    "position = [0, 1, 0]\n"
    "restitution = 0.8\n";

static void check_whole_run(void) {
    struct tumble_run* run = tumble_open("ball.toml", ball, "");
    check(tumble_error(run)[0] == '\0', "a valid scene has no error");
    const int32_t frames = tumble_frames(run);
    check(frames == 61, "a second has 61 frames");
    check(tumble_advance(run, 10) == 10, "ten frames are asked for");
    size_t part = 0, whole = 0;
    check(tumble_data(run, &part) != NULL && part > 0, "there is data of the first frames");
    check(tumble_advance(run, 1000) == frames, "it ends at the last frame");
    check(tumble_data(run, &whole) != NULL && whole > part, "there is data of all frames");
    tumble_close(run);
}

static void check_settings(void) {
    size_t size_a = 0, size_b = 0;
    struct tumble_run* a = tumble_open("ball.toml", ball, "body.ball.restitution=0.5\nsimulation.duration=0.5\n");
    struct tumble_run* b = tumble_open("ball.toml", ball, NULL);
    check(tumble_frames(a) == 31, "a setting replaces the duration");
    tumble_advance(a, 31);
    tumble_advance(b, 31);
    const unsigned char *of_a = tumble_data(a, &size_a), *of_b = tumble_data(b, &size_b);
    check(size_a != size_b || memcmp(of_a, of_b, size_a) != 0, "a setting changes the motion");
    tumble_close(a);
    tumble_close(b);
}

static void check_mistake(void) {
    size_t size = 1;
    struct tumble_run* run = tumble_open("ball.toml", "format = 1\n[simulation]\nduration = -1\n", NULL);
    check(strstr(tumble_error(run), "ball.toml:3:") != NULL, "an error names file and line");
    check(tumble_error_line(run) == 3 && tumble_error_column(run) == 12, "an error has line and column");
    check(tumble_frames(run) == 0 && tumble_advance(run, 5) == 0, "an invalid scene has no frames");
    check(tumble_data(run, &size) == NULL && size == 0, "an invalid scene has no data");
    tumble_close(run);
    tumble_close(NULL);
}

static char* text_of(const char* path) {
    FILE* file = fopen(path, "rb");
    if (file == NULL) return NULL;
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    char* text = malloc((size_t)size + 1);
    if (text != NULL) text[fread(text, 1, (size_t)size, file)] = '\0';
    fclose(file);
    return text;
}

static int write_data(int count, char** values) {
    char settings[4096] = "";
    for (int i = 4; i < count; ++i) {
        strncat(settings, values[i], sizeof settings - strlen(settings) - 2);
        strcat(settings, "\n");
    }
    char* text = text_of(values[3]);
    struct tumble_run* run = text != NULL ? tumble_open(values[2], text, settings) : NULL;
    free(text);
    if (run == NULL) return 1;
    tumble_advance(run, tumble_frames(run));
    size_t size = 0;
    const unsigned char* data = tumble_data(run, &size);
    fprintf(stderr, "%s\n", tumble_error(run));
    FILE* out = data != NULL ? fopen(values[1], "wb") : NULL;
    const int written = out != NULL && fwrite(data, 1, size, out) == size && fclose(out) == 0;
    tumble_close(run);
    return written ? 0 : 1;
}

static int compare_times(const void* a, const void* b) {
    const double difference = *(const double*)a - *(const double*)b;
    return (difference > 0) - (difference < 0);
}

static int print_time(const char* path) {
    enum { runs = 9 };
    double times[runs];
    char* text = text_of(path);
    if (text == NULL) return 1;
    for (int i = 0; i < runs; ++i) {
        const clock_t start = clock();
        struct tumble_run* run = tumble_open("scene.toml", text, "");
        size_t size = 0;
        tumble_advance(run, tumble_frames(run));
        tumble_data(run, &size);
        tumble_close(run);
        times[i] = 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC;
    }
    free(text);
    qsort(times, runs, sizeof times[0], compare_times);
    printf("%.3f\n", times[runs / 2]);
    return 0;
}

int main(int count, char** values) {
    if (count == 3 && strcmp(values[1], "--time") == 0) return print_time(values[2]);
    if (count > 3) return write_data(count, values);
    check_whole_run();
    check_settings();
    check_mistake();
    return failed;
}
