/* Sets a control of a V4L2 device, as vivid has them for its pictures and faults: set_control DEVICE NAME VALUE; 1
 * presses a button. */
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const int device = open(argv[1], O_RDWR);
  if (device < 0) {
    perror(argv[1]);
    return 1;
  }
  struct v4l2_queryctrl control = {.id = V4L2_CTRL_FLAG_NEXT_CTRL};
  for (; ioctl(device, VIDIOC_QUERYCTRL, &control) == 0; control.id |= V4L2_CTRL_FLAG_NEXT_CTRL) {
    if (strcmp((const char*)control.name, argv[2]) != 0) continue;
    struct v4l2_control set = {.id = control.id, .value = atoi(argv[3])};
    const int result = ioctl(device, VIDIOC_S_CTRL, &set);
    if (result < 0) perror(argv[2]);
    close(device);
    return result < 0;
  }
  fprintf(stderr, "%s has no control '%s'\n", argv[1], argv[2]);
  return 1;
}
