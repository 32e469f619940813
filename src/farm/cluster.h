/* One picture on many machines by MPI: rank 0 hands out tiles as the others ask for them, larger
 * runs first and smaller ones last, and takes what they made; it renders as well.  Every rank has
 * loaded the scene itself.
 *
 * Where the program was built without MPI there is no cluster, and cluster_begin() says so. */
#ifndef WRT_FARM_CLUSTER_H
#define WRT_FARM_CLUSTER_H

#include "farm/tilefile.h"

#include <signal.h>

struct cluster;

/* Joins the others that mpirun started; NULL when this program has no MPI. */
struct cluster *cluster_begin(void);
/* All ranks must come here. */
void cluster_end(struct cluster *c);

int cluster_rank(const struct cluster *c);
int cluster_ranks(const struct cluster *c);
/* Ranks on this machine. */
int cluster_neighbours(const struct cluster *c);

/* The largest of all ranks' numbers, and (where `who` is not NULL) the lowest rank that has it. */
int cluster_agree(struct cluster *c, int number, int *who);
/* Rank 0's number. */
uint64_t cluster_tell(struct cluster *c, uint64_t number);

/* What rank 0 and the others do with the tiles of a picture. */
struct cluster_job {
    struct tiling tiling;
    struct picture *picture; /* rank 0: all of it comes here */
    uint64_t check;          /* of the picture's head */
    const size_t *tiles;     /* rank 0: what is to be rendered */
    size_t tile_count;
    const volatile sig_atomic_t *stop; /* rank 0: nothing more is handed out once it is not 0 */
    void (*render)(void *context, const size_t *tiles, size_t n); /* into the picture */
    void (*arrived)(void *context, size_t tile);                  /* rank 0: from another */
    void *context;
};

struct cluster_stats {
    uint64_t messages, bytes; /* that rank 0 took and sent */
};

void cluster_render(struct cluster *c, const struct cluster_job *job, struct cluster_stats *stats);

#endif
