/* A text, then a stop, over HTTP with nothing but POSIX sockets:
   mmmd run --http 127.0.0.1:5880; cc -o hello docs/examples/hello.c && ./hello 5880 */
#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* Posts a body and prints the reply; 0 where the daemon has taken it. */
static int post(int port, const char *path, const char *body) {
  struct sockaddr_in at = {.sin_family = AF_INET, .sin_port = htons((unsigned short)port)};
  char text[8192];
  size_t have = 0;
  ssize_t n;
  int s = socket(AF_INET, SOCK_STREAM, 0);
  inet_pton(AF_INET, "127.0.0.1", &at.sin_addr);
  if (s < 0 || connect(s, (struct sockaddr *)&at, sizeof at) != 0) {
    perror("connect");
    return 1;
  }
  n = snprintf(text, sizeof text,
               "POST %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Length: %zu\r\n\r\n%s", path,
               strlen(body), body);
  if (write(s, text, (size_t)n) != n) {
    perror("write");
    return 1;
  }
  while (have < sizeof text - 1 && (n = read(s, text + have, sizeof text - 1 - have)) > 0) have += (size_t)n;
  text[have] = 0;
  close(s);
  const char *event = strstr(text, "\r\n\r\n");
  printf("%s", event ? event + 4 : text);
  return strncmp(text, "HTTP/1.1 200", 12) != 0;
}

int main(int argc, char **argv) {
  int port = argc > 1 ? atoi(argv[1]) : 5880;
  int refused = post(port, "/v1/cmd", "wave with your right hand");
  sleep(2);
  return post(port, "/v1/ctl", "stop") || refused;
}
