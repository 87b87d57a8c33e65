/* Workspaces of a text and of bytes, at their edges, and on a stage. */
#include <math.h>
#include <stdlib.h>

#include "tests/c/check.h"
#include "tests/c/parts.h"
#include "tests/c/placed.h"

static const char* const desk =
    "wale 1\n"
    "/// On the table.\n"
    "workspace desk {\n"
    "  patch left = corduroy { at -30 mm, 0 mm; size 40 mm, 50 mm; shape ellipse }\n"
    "  patch right = corduroy { at 30 mm, 0 mm; size 40 mm, 50 mm; mark roughness, low 0.2, \"still\" }\n"
    "}\n";

static WaleWorkspace* of_text(void) {
  WaleWorkspace* workspace = NULL;
  CHECK_GOOD(wale_library_workspace(library, WALE_TEXT(desk), NULL, &workspace, &error));
  return workspace;
}

static void figures(void) {
  WaleWorkspace* workspace = of_text();
  WaleWorkspaceDetails details = {.size = sizeof details};
  WaleWorkspacePatch patch = {.size = sizeof patch};
  WaleWorkspaceMark mark = {.size = sizeof mark};
  CHECK_GOOD(wale_workspace_details(workspace, &details, &error));
  CHECK(is_text(details.name, "desk") && is_text(details.documentation, "On the table."));
  CHECK(is_text(details.device, "sandpaper") && details.patches == 2 && details.warnings == 0);
  CHECK_GOOD(wale_workspace_patch(workspace, 0, &patch, &error));
  CHECK(is_text(patch.name, "left") && is_text(patch.made_of, "corduroy") && patch.has_shape == 1 && patch.marks == 0);
  CHECK(fabs(patch.x + 0.03) < 1e-6 && patch.y == 0 && fabs(patch.height - 0.05) < 1e-6 && fabs(patch.rim - 0.001) < 1e-6);
  CHECK(strncmp(desk + patch.text_begin, "patch left =", 12) == 0 && desk[patch.text_end - 1] == '}');
  CHECK_GOOD(wale_workspace_patch(workspace, 1, &patch, &error));
  CHECK(patch.has_shape == 0 && patch.marks == 1);
  CHECK_GOOD(wale_workspace_mark(workspace, 1, 0, &mark, &error));
  CHECK(is_text(mark.slider, "roughness") && is_text(mark.says, "still") && mark.is_percept == 1);
  CHECK(fabs(mark.low - 0.2) < 1e-6 && isnan(mark.high));
  WaleShape* shape = NULL;
  WaleProgram* program = NULL;
  CHECK_GOOD(wale_workspace_shape(workspace, 0, &shape, &error));
  CHECK(fabs(wale_shape_size(shape).x - 0.04) < 1e-6);
  wale_shape_free(shape);
  CHECK_GOOD(wale_workspace_shape(workspace, 1, &shape, &error));
  CHECK(shape == NULL);
  CHECK_GOOD(wale_workspace_program(workspace, 1, &program, &error));
  wale_program_free(program);

  CHECK_MALFORMED(wale_workspace_patch(workspace, 2, &patch, &error));
  CHECK_MALFORMED(wale_workspace_patch(NULL, 0, &patch, &error));
  CHECK_MALFORMED(wale_workspace_patch(workspace, 0, NULL, &error));
  CHECK_MALFORMED(wale_workspace_mark(workspace, 0, 0, &mark, &error));
  CHECK_MALFORMED(wale_workspace_mark(workspace, 2, 0, &mark, &error));
  CHECK_MALFORMED(wale_workspace_program(workspace, 2, &program, &error));
  CHECK_MALFORMED(wale_workspace_shape(workspace, 2, &shape, &error));
  CHECK_MALFORMED(wale_workspace_details(NULL, &details, &error));
  CHECK(wale_workspace_warning(workspace, 0) == NULL && wale_workspace_warning(NULL, 0) == NULL);
  wale_workspace_free(workspace), wale_workspace_free(NULL);
}

static void bytes(void) {
  WaleWorkspace *workspace = of_text(), *again = NULL;
  size_t length = 0, same = 0;
  CHECK_GOOD(wale_workspace_bytes(workspace, NULL, 0, &length, &error));
  unsigned char *data = malloc(length), *other = malloc(length);
  CHECK_GOOD(wale_workspace_bytes(workspace, data, length, &length, &error));
  CHECK_GOOD(wale_workspace_load(data, length, &again, &error));
  CHECK_GOOD(wale_workspace_bytes(again, other, length, &same, &error));
  CHECK(same == length && memcmp(data, other, length) == 0);
  WaleWorkspacePatch patch = {.size = sizeof patch};
  CHECK_GOOD(wale_workspace_patch(again, 0, &patch, &error));
  CHECK(patch.text_end == 0);
  wale_workspace_free(again);
  CHECK_CODE(WALE_CODE_damaged_file, wale_workspace_load(data, length - 1, &again, &error));
  CHECK(again == NULL);
  CHECK_MALFORMED(wale_workspace_load(NULL, 3, &again, &error));
  CHECK_MALFORMED(wale_workspace_load(data, length, NULL, &error));
  CHECK_MALFORMED(wale_workspace_bytes(NULL, NULL, 0, &length, &error));
  CHECK_MALFORMED(wale_workspace_bytes(workspace, NULL, 0, NULL, &error));
  free(data), free(other), wale_workspace_free(workspace);
}

static void asked_for(void) {
  WaleWorkspace* workspace = NULL;
  WaleWorkspaceOptions options = {.size = sizeof options, .workspace = WALE_TEXT("desk"), .legibility = 1};
  CHECK_GOOD(wale_library_workspace(library, WALE_TEXT(desk), &options, &workspace, &error));
  wale_workspace_free(workspace);
  options.workspace = WALE_TEXT("desc");
  CHECK_CODE(WALE_CODE_unknown_workspace, wale_library_workspace(library, WALE_TEXT(desk), &options, &workspace, &error));
  CHECK(workspace == NULL);
  options.legibility = 2;
  CHECK_MALFORMED(wale_library_workspace(library, WALE_TEXT(desk), &options, &workspace, &error));
  CHECK_MALFORMED(wale_library_workspace(NULL, WALE_TEXT(desk), NULL, &workspace, &error));
  CHECK_MALFORMED(wale_library_workspace(library, WALE_TEXT(desk), NULL, NULL, &error));
  CHECK_CODE(WALE_CODE_unreadable_file,
             wale_library_open_workspace(library, WALE_TEXT("/nowhere/desk.wws"), NULL, &workspace, &error));
}

static void on_a_stage(void) {
  WaleWorkspace* workspace = of_text();
  WaleStage* stage = new_stage();
  WalePatch* patches[2] = {NULL, NULL};
  CHECK_GOOD(wale_stage_add_workspace(stage, workspace, patches, &error));
  CHECK(wale_stage_size(stage) == 2 && wale_patch_exists(patches[0]) && wale_patch_exists(patches[1]));
  CHECK_GOOD(wale_stage_add_workspace(stage, workspace, NULL, &error));
  CHECK(wale_stage_size(stage) == 4);
  wale_run_free(run_for(stage, 0.2));
  CHECK_MALFORMED(wale_stage_add_workspace(NULL, workspace, NULL, &error));
  CHECK_MALFORMED(wale_stage_add_workspace(stage, NULL, NULL, &error));
  wale_patch_free(patches[0]), wale_patch_free(patches[1]), wale_workspace_free(workspace), wale_stage_free(stage);
}

int workspace_parts(void) {
  run_parts((Part[]){figures, bytes, asked_for, on_a_stage, NULL});
  return failures;
}
