"""Random requests by the API's own description: no crash, no answer that it does not describe."""

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis import GenerationMode
from schemathesis.specs.openapi.checks import negative_data_rejection, positive_data_acceptance

from simulearn.studio import create_app
from simulearn.studio.settings import Settings

# What requests hold is checked by rules that no description of types can give.
BY_RULES = [negative_data_rejection, positive_data_acceptance]
WITHOUT_INPUT = {"/api/version", "/api/library", "/api/materials", "/api/printers"}
BOUNDED = settings(
    max_examples=15,
    deadline=None,
    database=None,
    derandomize=True,
    phases=(Phase.generate,),
    suppress_health_check=list(HealthCheck),
)


@pytest.fixture(scope="module")
def api():
    app = create_app(Settings(hosts=("testserver",)))
    return schemathesis.openapi.from_asgi("/openapi.json", app)


@pytest.mark.parametrize("mode", [GenerationMode.POSITIVE, GenerationMode.NEGATIVE])
def test_every_answer_is_as_described(api, mode):
    statuses = set()
    for operation in (result.ok() for result in api.get_all_operations()):
        if mode is GenerationMode.NEGATIVE and operation.path in WITHOUT_INPUT:
            continue

        @BOUNDED
        @given(case=operation.as_strategy(generation_mode=mode))
        def check(case):
            response = case.call(timeout=120)  # the first use of a model loads JAX
            assert response.status_code < 500
            case.validate_response(response, excluded_checks=BY_RULES)
            statuses.add(response.status_code)

        check()
    assert 200 in statuses
    assert statuses & {400, 422}


def test_the_description_names_every_route_and_what_it_can_be_refused_for(api):
    raw = api.raw_schema
    assert {"/api/version", "/api/library", "/api/materials", "/api/printers"} <= set(raw["paths"])
    simulate = raw["paths"]["/api/simulate"]["post"]
    assert {"200", "400", "403", "413", "415", "422", "429"} <= set(simulate["responses"])
    answers = simulate["responses"]["200"]["content"]
    assert set(answers) == {"application/json", "application/vnd.simulearn.frames"}
    for path in raw["paths"].values():
        for operation in path.values():
            for status, response in operation["responses"].items():
                if int(status) >= 400:
                    assert set(response["content"]) == {"application/problem+json"}
