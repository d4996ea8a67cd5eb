
CREATE TABLE public.deleted (
    id text NOT NULL
);

CREATE TABLE public.experiments (
    id text NOT NULL,
    method text NOT NULL,
    parameters json NOT NULL,
    listed boolean NOT NULL,
    transient boolean NOT NULL,
    owner text NOT NULL,
    created_at bigint NOT NULL,
    status text NOT NULL,
    attempts integer NOT NULL,
    timings json NOT NULL,
    diagnostics json DEFAULT '{}'::json NOT NULL,
    environment json DEFAULT '{}'::json NOT NULL,
    error text,
    started_at bigint,
    finished_at bigint,
    depth integer DEFAULT 8 NOT NULL,
    wanted text DEFAULT 'texture'::text NOT NULL
);

CREATE TABLE public.inputs (
    experiment text NOT NULL,
    place integer NOT NULL,
    sample text NOT NULL,
    x integer NOT NULL,
    y integer NOT NULL,
    width integer NOT NULL,
    height integer NOT NULL,
    first integer DEFAULT 0 NOT NULL,
    count integer DEFAULT 1 NOT NULL
);

CREATE TABLE public.outputs (
    experiment text NOT NULL,
    name text NOT NULL,
    place integer NOT NULL,
    title text NOT NULL,
    media_type text NOT NULL,
    width integer NOT NULL,
    height integer NOT NULL,
    bytes bigint NOT NULL,
    digest text NOT NULL,
    kind text DEFAULT 'view'::text NOT NULL,
    frames integer DEFAULT 1 NOT NULL,
    rate double precision DEFAULT '0'::double precision NOT NULL
);

CREATE TABLE public.samples (
    id text NOT NULL,
    digest text NOT NULL,
    width integer NOT NULL,
    height integer NOT NULL,
    channels integer NOT NULL,
    depth integer NOT NULL,
    transparent boolean NOT NULL,
    created_at bigint NOT NULL,
    frames integer NOT NULL,
    media_type text NOT NULL,
    title text,
    bundled boolean NOT NULL,
    rate double precision DEFAULT '0'::double precision NOT NULL,
    owner text
);

INSERT INTO public.deleted VALUES ('gone');

INSERT INTO public.experiments VALUES ('made', 'rpn', '{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}', true, false, 'ann', 1772366400000000, 'succeeded', 1, '{"b": 0.5, "a": 0.25}', '{}', '{}', NULL, 1772366400000000, 1772366409000000, 8, 'texture');
INSERT INTO public.experiments VALUES ('waits', 'rpn', '{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}', true, false, 'ann', 1772366399000000, 'queued', 0, '{}', '{}', '{}', NULL, NULL, NULL, 8, 'texture');
INSERT INTO public.experiments VALUES ('runs', 'rpn', '{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}', true, false, 'ann', 1772366398000000, 'running', 3, '{}', '{}', '{}', NULL, 1772366400000000, NULL, 8, 'texture');
INSERT INTO public.experiments VALUES ('broke', 'rpn', '{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}', true, false, 'ann', 1772366397000000, 'failed', 7, '{}', '{}', '{}', 'too large', 1772366400000000, 1772366409000000, 8, 'texture');
INSERT INTO public.experiments VALUES ('stopped', 'rpn', '{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}', true, false, 'ann', 1772366396000000, 'cancelled', 0, '{}', '{}', '{}', NULL, NULL, 1772366409000000, 8, 'texture');
INSERT INTO public.experiments VALUES ('passing', 'rpn', '{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}', true, true, 'ann', 1772366395000000, 'running', 1, '{}', '{}', '{}', NULL, 1772366400000000, NULL, 8, 'texture');

INSERT INTO public.inputs VALUES ('made', 0, 'upload', 1, 2, 30, 40, 0, 1);
INSERT INTO public.inputs VALUES ('waits', 0, 'upload', 1, 2, 30, 40, 0, 1);
INSERT INTO public.inputs VALUES ('runs', 0, 'upload', 1, 2, 30, 40, 0, 1);
INSERT INTO public.inputs VALUES ('broke', 0, 'upload', 1, 2, 30, 40, 0, 1);
INSERT INTO public.inputs VALUES ('stopped', 0, 'upload', 1, 2, 30, 40, 0, 1);
INSERT INTO public.inputs VALUES ('passing', 0, 'upload', 1, 2, 30, 40, 0, 1);

INSERT INTO public.outputs VALUES ('made', 'texture', 0, 'Texture', 'image/png', 64, 32, 5368709120, 'texturetexturetexturetexturetexturetexture', 'texture', 1, 0);
INSERT INTO public.outputs VALUES ('made', 'crop', 1, 'Crop', 'image/png', 64, 32, 5368709120, 'cropcropcropcropcropcrop', 'view', 1, 0);

INSERT INTO public.samples VALUES ('gravel', 'gravelgravelgravelgravel', 640, 427, 3, 8, false, 1772366400000000, 1, 'image/png', 'Gravel', true, 0, NULL);
INSERT INTO public.samples VALUES ('upload', 'uploaduploaduploadupload', 640, 427, 3, 8, false, 1772366400000000, 1, 'image/png', NULL, false, 0, 'ann');

ALTER TABLE ONLY public.deleted
    ADD CONSTRAINT deleted_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.experiments
    ADD CONSTRAINT experiments_pkey PRIMARY KEY (id);

ALTER TABLE ONLY public.inputs
    ADD CONSTRAINT inputs_pkey PRIMARY KEY (experiment, place);

ALTER TABLE ONLY public.outputs
    ADD CONSTRAINT outputs_pkey PRIMARY KEY (experiment, name);

ALTER TABLE ONLY public.samples
    ADD CONSTRAINT samples_pkey PRIMARY KEY (id);

CREATE INDEX experiments_by_age ON public.experiments USING btree (status, listed, created_at, id);

CREATE INDEX ix_experiments_finished_at ON public.experiments USING btree (finished_at);

CREATE INDEX ix_inputs_sample ON public.inputs USING btree (sample);

CREATE INDEX ix_outputs_digest ON public.outputs USING btree (digest);

CREATE INDEX ix_samples_created_at ON public.samples USING btree (created_at);

CREATE INDEX ix_samples_digest ON public.samples USING btree (digest);

ALTER TABLE ONLY public.inputs
    ADD CONSTRAINT inputs_experiment_fkey FOREIGN KEY (experiment) REFERENCES public.experiments(id) ON DELETE CASCADE;

ALTER TABLE ONLY public.inputs
    ADD CONSTRAINT inputs_sample_fkey FOREIGN KEY (sample) REFERENCES public.samples(id);

ALTER TABLE ONLY public.outputs
    ADD CONSTRAINT outputs_experiment_fkey FOREIGN KEY (experiment) REFERENCES public.experiments(id) ON DELETE CASCADE;

