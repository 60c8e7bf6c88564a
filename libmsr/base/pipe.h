/* pipe.h - pipes that much goes through. */
#ifndef MSRI_PIPE_H
#define MSRI_PIPE_H

/* Lets a pipe hold as much as any user's may, if the system can: who writes and who reads then take
 * turns less often. What is no pipe is left alone. */
void msri_pipe_widen(int fd);

#endif
