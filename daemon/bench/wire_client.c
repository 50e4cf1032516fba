/* The smallest client: one write, poll and read until all answers are there. The floor of a pty and its machine.
   usage: wire_client TTY REQUEST_HEX REPLY_BYTES SECONDS -> prints the microseconds of each cycle, one a line. */
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

static double now_us(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1e6 + t.tv_nsec * 1e-3;
}

int main(int argc, char **argv) {
    static unsigned char request[8192], reply[65536];
    static double took[200000];
    if (argc != 5) return 2;
    int fd = open(argv[1], O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (fd < 0) return 1;
    struct termios t;
    tcgetattr(fd, &t);
    cfmakeraw(&t);
    tcsetattr(fd, TCSANOW, &t);
    int n = strlen(argv[2]) / 2, want = atoi(argv[3]), cycles = 0;
    for (int i = 0; i < n; i++) sscanf(argv[2] + 2 * i, "%2hhx", &request[i]);
    struct pollfd p = {.fd = fd, .events = POLLIN};
    double end = now_us() + atof(argv[4]) * 1e6;
    while (now_us() < end && cycles < 200000) {
        double start = now_us();
        if (write(fd, request, n) != n) return 1;
        for (int got = 0; got < want;) {
            if (poll(&p, 1, 1000) != 1) return 1;
            int k = read(fd, reply, sizeof reply);
            if (k > 0) got += k;
        }
        took[cycles++] = now_us() - start;
    }
    for (int i = 0; i < cycles; i++) printf("%.1f\n", took[i]);
    return 0;
}
