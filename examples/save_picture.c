/* Saves pictures of one of the robot's cameras as JPEG files, without moving the robot, and says how old each was.
 * Usage: save_picture [CAMERA [COUNT]]; default: the robot's first camera, 1. Writes picture-NUMBER.jpg here.
 * Exit status 2: wrong arguments. */
#include <ctype.h>
#include <inttypes.h>
#include <kenaf/hrt.h>
#include <stdio.h>
#include <stdlib.h>

static const double kTimeout_s = 5; /* wall clock; a real camera may take a second for its first picture */

static int save(const unsigned char* file, const hrt_picture* picture) {
  char path[64];
  snprintf(path, sizeof path, "picture-%" PRIu64 ".jpg", picture->number);
  FILE* out = fopen(path, "wb");
  int fine = out != NULL && fwrite(file, 1, picture->bytes, out) == picture->bytes;
  if (out != NULL && fclose(out) != 0) fine = 0;
  if (!fine) {
    perror(path);
    return 0;
  }
  printf("%s: %d x %d, camera %s, robot time %.3f s, age %.1f ms\n", path, (int)picture->width, (int)picture->height,
         picture->camera, picture->time_s, picture->age_ms);
  return 1;
}

/* A whole number from 1 to 1000000; 0 of any other text. */
static int count_from(const char* text) {
  char* end = NULL;
  long count = strtol(text, &end, 10);
  return isdigit((unsigned char)*text) && *end == '\0' && count >= 1 && count <= 1000000 ? (int)count : 0;
}

int main(int argc, char** argv) {
  const char* camera = argc > 1 ? argv[1] : NULL;
  int count = argc > 2 ? count_from(argv[2]) : 1;
  if (argc > 3 || count == 0 || (camera != NULL && *camera == '-')) {
    fprintf(stderr, "usage: save_picture [CAMERA [COUNT]], COUNT a whole number from 1 to 1000000\n");
    return 2;
  }
  size_t capacity = 1 << 20;
  unsigned char* file = malloc(capacity);
  hrt_config config = hrt_config_default();
  int result = hrt_config_load(&config);
  config.reset_robot = 0;
  if (result == HRT_OK) result = hrt_kenaf_init_with(&config);
  hrt_picture picture = hrt_picture_init();
  int saved = 0;
  while (file != NULL && result == HRT_OK && saved < count) {
    result = hrt_get_picture(camera, HRT_PICTURE_JPEG, file, capacity, kTimeout_s, &picture);
    if (result == HRT_OK && !save(file, &picture)) break;
    if (result == HRT_OK) ++saved;
    if (result == HRT_E_ARGUMENT && picture.bytes > capacity) { /* it is larger than those before */
      capacity = 2 * picture.bytes;
      free(file);
      file = malloc(capacity);
      result = HRT_OK;
    }
  }
  if (result != HRT_OK) fprintf(stderr, "save_picture: %s: %s\n", hrt_error_name(result), hrt_last_error());
  free(file);
  result = hrt_close();
  if (result != HRT_OK) fprintf(stderr, "save_picture: close: %s: %s\n", hrt_error_name(result), hrt_last_error());
  return result == HRT_OK && saved == count ? 0 : 1;
}
