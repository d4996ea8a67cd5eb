"""Share of the queue: the part that one client's waiting experiments may take, over HTTP."""

from typing import Any

from tests.web.test_limits import FORM, own


def test_beyond_its_share_a_client_is_refused_and_others_are_not(serve: Any, tmp_path: Any) -> None:
    """In the API, on the pages, and of outputs at 16 bits; whoever else asks comes in, and comes next."""
    with serve(tmp_path, limits=True, queue_limit=40, queue_share=0.1, limit_address=100) as site:
        done = site.finished()
        with site.gate.closed(), site.visitor(headers=own()) as greedy, site.visitor(headers=own()) as modest:
            answers = [site.run(client=greedy, wait=False) for _ in range(9)]
            taken = [answer for answer in answers if answer.status_code == 202]
            assert len(taken) in (4, 5)  # one of them may have begun
            refused = answers[-1]
            assert refused.status_code == 429
            assert int(refused.headers["Retry-After"]) > 0
            assert "4 of them wait already" in refused.json()["detail"]
            page = greedy.post("/experiments", data=FORM)
            assert (page.status_code, "4 of them wait already" in page.text) == (429, True)
            deep = greedy.get(f"{done['outputs'][0]['url']}?depth=16")
            assert deep.status_code == 429
            late = site.run(client=modest, wait=False)
            assert late.status_code == 202
            place = modest.get(late.json()["url"]).json()["position"]
            assert place is None or place <= 2
            last = greedy.get(taken[-1].json()["url"]).json()["position"]
            assert last == max(last, place or 0) > (place or 0)


def test_made_up_tokens_take_half_of_the_queue(serve: Any, tmp_path: Any) -> None:
    with serve(tmp_path, limits=True, queue_limit=20, queue_share=0.2) as site, site.gate.closed():
        answers = []
        for _ in range(16):
            with site.visitor(headers=own()) as visitor:
                answers.append(site.run(client=visitor, wait=False).status_code)
        assert answers.count(202) in (10, 11)
        assert set(answers) == {202, 429}
        with site.visitor(headers=own() | {"X-Forwarded-For": "203.0.113.7"}) as visitor:
            assert site.run(client=visitor, wait=False).status_code == 202
