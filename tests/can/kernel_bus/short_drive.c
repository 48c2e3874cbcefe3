/* Drives 30 mm forward and turns by 5 degrees; exit status 0 if all went well, else it says what did not. */
#include <stdio.h>

#include <kenaf/hrt.h>

int main(void) {
  if (hrt_kenaf_init() == HRT_OK && hrt_go_forward(30) == HRT_OK && hrt_turning(5) == HRT_OK && hrt_close() == HRT_OK)
    return 0;
  fprintf(stderr, "short_drive: %s\n", hrt_last_error());
  return 1;
}
