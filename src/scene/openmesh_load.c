/* Finds OpenMesh's analysis: linked into the program, or in a module that is loaded when it is
 * first asked for, since the C++ libraries behind it take longer to load than a small picture. */
#include "config.h"

#include "scene/openmesh.h"

#include "base/mem.h"

#ifdef HAVE_OPENMESH

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define MODULE "openmesh.so"

typedef int analyse(const struct vec3 *, size_t, const struct triangle_corners *, size_t,
                    openmesh_normal *, struct mesh_report *);

/* Not there unless the program was linked with it, as tests are. */
extern analyse openmesh_module_analyse __attribute__((weak));

/* The folder of the running program; false where the system does not tell. */
static bool program_folder(char folder[PATH_MAX])
{
    ssize_t n = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    if (n <= 0)
        return false;
    folder[n] = '\0';
    *strrchr(folder, '/') = '\0';
    return true;
}

/* As built, as installed and moved, as installed.  It stays loaded. */
static void *open_module(void)
{
    static const char *const beside[] = {"/" MODULE, "/../libexec/wrt/" MODULE};
    char path[PATH_MAX], folder[PATH_MAX];
    void *module = NULL;
    bool known = program_folder(folder);
    for (size_t i = 0; i < sizeof beside / sizeof *beside && known && !module; i++)
        if (snprintf(path, sizeof path, "%s%s", folder, beside[i]) < (int)sizeof path)
            module = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    return module ? module : dlopen(MODULE_FOLDER "/" MODULE, RTLD_NOW | RTLD_NODELETE);
}

/* NULL where it is not installed. */
static analyse *find_analysis(void)
{
    analyse *found = NULL;
    if (openmesh_module_analyse)
        return openmesh_module_analyse;
    void *module = open_module();
    void *symbol = module ? dlsym(module, "openmesh_module_analyse") : NULL;
    memcpy(&found, &symbol, sizeof found);
    return found;
}

const char *openmesh_analyse(const struct vec3 *points, size_t point_count,
                             const struct triangle_corners *faces, size_t face_count,
                             struct mesh_report *report)
{
    static const char *const reasons[] = {
        [OPENMESH_DONE] = NULL,
        [OPENMESH_TOO_LARGE] = "the mesh has more faces than OpenMesh can hold",
        [OPENMESH_FAILED] = "OpenMesh could not analyse the mesh",
    };
    analyse *by_openmesh = find_analysis();
    *report = (struct mesh_report){0};
    if (!by_openmesh)
        return "the module " MODULE " that holds OpenMesh cannot be loaded";
    int result = by_openmesh(points, point_count, faces, face_count, mesh_face_normal, report);
    if (result == OPENMESH_NO_MEMORY)
        mem_exhausted(face_count * 3 * sizeof(uint64_t)); /* its edges, at least */
    return reasons[result];
}

#else

const char *openmesh_analyse(const struct vec3 *points, size_t point_count,
                             const struct triangle_corners *faces, size_t face_count,
                             struct mesh_report *report)
{
    (void)points;
    (void)point_count;
    (void)faces;
    (void)face_count;
    *report = (struct mesh_report){0};
    return "this wrt was built without OpenMesh";
}

#endif
