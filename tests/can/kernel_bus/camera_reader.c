/* Reads pictures from a camera of the robot by hrt.h alone, and says what it gets: camera_reader CAMERA. Goes on when a
 * line of input comes. camera_test.sh has the claims. */
#include <kenaf/hrt.h>
#include <stdio.h>

static unsigned char data[320 * 180 * 3];
static const double kTimeout_s = 20;

static int failed(const char* what) {
  printf("%s: %s\n", what, hrt_last_error());
  return 1;
}

static void wait_for_line(void) {
  for (int c = getchar(); c != '\n' && c != EOF; c = getchar()) {
  }
}

static int get(const char* camera, int format, hrt_picture* picture) {
  return hrt_get_picture(camera, format, data, sizeof data, kTimeout_s, picture);
}

static void print_means(size_t bytes) {
  unsigned long sum[3] = {0, 0, 0};
  for (size_t i = 0; i < bytes; ++i) sum[i % 3] += data[i];
  const unsigned long pixels = (unsigned long)bytes / 3;
  printf("mean red %lu green %lu blue %lu\n", sum[0] / pixels, sum[1] / pixels, sum[2] / pixels);
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const char* camera = argv[1];
  setvbuf(stdout, NULL, _IOLBF, 0);
  if (hrt_kenaf_init() != HRT_OK) return failed("init");
  hrt_picture picture = hrt_picture_init();
  int result = get("Rear", HRT_PICTURE_RGB, &picture);
  printf("Rear: %s: %s\n", hrt_error_name(result), hrt_last_error());
  result = get("BirdsEye", HRT_PICTURE_RGB, &picture);
  printf("BirdsEye: %s: %s\n", hrt_error_name(result), hrt_last_error());

  if (get(camera, HRT_PICTURE_RGB, &picture) != HRT_OK) return failed("rgb");
  printf("rgb %d x %d, %zu bytes\n", (int)picture.width, (int)picture.height, picture.bytes);
  print_means(picture.bytes);
  for (int i = 0; i < 3; ++i) {
    const uint64_t before = picture.number;
    if (get(NULL, HRT_PICTURE_JPEG, &picture) != HRT_OK) return failed("jpeg");
    const double ago_ms = 1e3 * (hrt_time() - picture.time_s);
    printf("jpeg %d x %d of %s: %02x%02x ... %02x%02x, number %s, age %.1f ms, by robot time %.1f ms\n",
           (int)picture.width, (int)picture.height, picture.camera, data[0], data[1], data[picture.bytes - 2],
           data[picture.bytes - 1], picture.number > before ? "higher" : "not higher", picture.age_ms, ago_ms);
  }
  puts("unplug it");
  wait_for_line();
  for (result = HRT_OK; result == HRT_OK;) result = get(camera, HRT_PICTURE_RGB, &picture);
  printf("unplugged: %s: %s\n", hrt_error_name(result), hrt_last_error());
  result = hrt_go_forward(20);
  printf("the robot: %s\n", hrt_error_name(result));
  result = get(camera, HRT_PICTURE_RGB, &picture);
  printf("plugged in: %s\n", result == HRT_OK ? "HRT_OK" : hrt_last_error());
  return hrt_close() == HRT_OK ? 0 : failed("close");
}
