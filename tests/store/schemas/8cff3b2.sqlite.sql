BEGIN TRANSACTION;
CREATE TABLE deleted (
	id TEXT NOT NULL, 
	PRIMARY KEY (id)
);
INSERT INTO "deleted" VALUES('gone');
CREATE TABLE experiments (
	id TEXT NOT NULL, 
	method TEXT NOT NULL, 
	parameters JSON NOT NULL, 
	listed BOOLEAN NOT NULL, 
	transient BOOLEAN NOT NULL, 
	owner TEXT NOT NULL, 
	created_at BIGINT NOT NULL, 
	status TEXT NOT NULL, 
	attempts INTEGER NOT NULL, 
	timings JSON NOT NULL, 
	error TEXT, 
	started_at BIGINT, 
	finished_at BIGINT, 
	PRIMARY KEY (id)
);
INSERT INTO "experiments" VALUES('made','rpn','{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}',1,0,'ann',1772366400000000,'succeeded',1,'{"b": 0.5, "a": 0.25}',NULL,1772366400000000,1772366409000000);
INSERT INTO "experiments" VALUES('waits','rpn','{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}',1,0,'ann',1772366399000000,'queued',0,'{}',NULL,NULL,NULL);
INSERT INTO "experiments" VALUES('runs','rpn','{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}',1,0,'ann',1772366398000000,'running',3,'{}',NULL,1772366400000000,NULL);
INSERT INTO "experiments" VALUES('broke','rpn','{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}',1,0,'ann',1772366397000000,'failed',7,'{}','too large',1772366400000000,1772366409000000);
INSERT INTO "experiments" VALUES('stopped','rpn','{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}',1,0,'ann',1772366396000000,'cancelled',0,'{}',NULL,NULL,1772366409000000);
INSERT INTO "experiments" VALUES('passing','rpn','{"width": 64, "height": 32, "seed": 9007199254740991, "\u03c3": null}',1,1,'ann',1772366395000000,'running',1,'{}',NULL,1772366400000000,NULL);
CREATE TABLE inputs (
	experiment TEXT NOT NULL, 
	place INTEGER NOT NULL, 
	sample TEXT NOT NULL, 
	x INTEGER NOT NULL, 
	y INTEGER NOT NULL, 
	width INTEGER NOT NULL, 
	height INTEGER NOT NULL, 
	PRIMARY KEY (experiment, place), 
	FOREIGN KEY(experiment) REFERENCES experiments (id) ON DELETE CASCADE, 
	FOREIGN KEY(sample) REFERENCES samples (id)
);
INSERT INTO "inputs" VALUES('made',0,'upload',1,2,30,40);
INSERT INTO "inputs" VALUES('waits',0,'upload',1,2,30,40);
INSERT INTO "inputs" VALUES('runs',0,'upload',1,2,30,40);
INSERT INTO "inputs" VALUES('broke',0,'upload',1,2,30,40);
INSERT INTO "inputs" VALUES('stopped',0,'upload',1,2,30,40);
INSERT INTO "inputs" VALUES('passing',0,'upload',1,2,30,40);
CREATE TABLE outputs (
	experiment TEXT NOT NULL, 
	name TEXT NOT NULL, 
	place INTEGER NOT NULL, 
	title TEXT NOT NULL, 
	media_type TEXT NOT NULL, 
	width INTEGER NOT NULL, 
	height INTEGER NOT NULL, 
	bytes BIGINT NOT NULL, 
	digest TEXT NOT NULL, 
	PRIMARY KEY (experiment, name), 
	FOREIGN KEY(experiment) REFERENCES experiments (id) ON DELETE CASCADE
);
INSERT INTO "outputs" VALUES('made','texture',0,'Texture','image/png',64,32,5368709120,'texturetexturetexturetexturetexturetexture');
INSERT INTO "outputs" VALUES('made','crop',1,'Crop','image/png',64,32,5368709120,'cropcropcropcropcropcrop');
CREATE TABLE samples (
	id TEXT NOT NULL, 
	digest TEXT NOT NULL, 
	width INTEGER NOT NULL, 
	height INTEGER NOT NULL, 
	channels INTEGER NOT NULL, 
	depth INTEGER NOT NULL, 
	transparent BOOLEAN NOT NULL, 
	created_at BIGINT NOT NULL, 
	frames INTEGER NOT NULL, 
	media_type TEXT NOT NULL, 
	title TEXT, 
	bundled BOOLEAN NOT NULL, 
	owner TEXT, 
	PRIMARY KEY (id)
);
INSERT INTO "samples" VALUES('gravel','gravelgravelgravelgravel',640,427,3,8,0,1772366400000000,1,'image/png','Gravel',1,NULL);
INSERT INTO "samples" VALUES('upload','uploaduploaduploadupload',640,427,3,8,0,1772366400000000,1,'image/png',NULL,0,'ann');
CREATE INDEX ix_samples_digest ON samples (digest);
CREATE INDEX ix_samples_created_at ON samples (created_at);
CREATE INDEX experiments_by_age ON experiments (status, listed, created_at, id);
CREATE INDEX ix_experiments_finished_at ON experiments (finished_at);
CREATE INDEX ix_inputs_sample ON inputs (sample);
CREATE INDEX ix_outputs_digest ON outputs (digest);
COMMIT;
