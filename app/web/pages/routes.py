"""Routes of all pages."""

from fastapi import APIRouter

from app.web.pages import archive, catalogue, compare, experiment, home, methods, robots, sample, structure

router = APIRouter(include_in_schema=False)
for page in (home, sample, experiment, compare, archive, structure, methods, catalogue, robots):
    router.include_router(page.router)
